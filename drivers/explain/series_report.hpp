// The report of what series of vesicles say of missing effects: series.json, series.html and words.
#pragma once

#include <filesystem>

#include "drivers/explain/series_ensembles.hpp"

namespace traceraft::explain {

// `request`: by which it was found. Throws IoError.
void write_series_explanation(const std::filesystem::path& folder,
                              const observations::MeasuredVesicles& data,
                              const config::Configuration& model, const SeriesEnsembles& ensembles,
                              const selection::SeriesExplanation& found,
                              const selection::SeriesRequest& request, bool quiet);

}  // namespace traceraft::explain
