// What series of vesicles say of missing effects: series.json, series.html and words.
#pragma once

#include <filesystem>

#include "drivers/explain/series_ensembles.hpp"

namespace traceraft {

// `request`: by which it was found. Throws IoError.
void write_series_explanation(const std::filesystem::path& folder, const MeasuredVesicles& data,
                              const Configuration& model, const SeriesEnsembles& ensembles,
                              const SeriesExplanation& found, const SeriesRequest& request,
                              bool quiet);

}  // namespace traceraft
