// The verdict of series in the units of their user: series.json, verdict.json and model.toml.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/explain/series_ensembles.hpp"
#include "drivers/explain/verdict.hpp"
#include "verification/observations/perimeter_law.hpp"

namespace traceraft::explain {

// The units with the D that the series say if nothing is missing.
physics::Units found_units(const config::Configuration& model,
                           const selection::SeriesExplanation& found);

// Effects that explain the data, the best first; none if nothing was named.
std::vector<std::string> class_of(const selection::SeriesExplanation& found);

// The exponent of the perimeter: measured, or simulated with this model.
struct PerimeterExponent {
  std::string model;
  observations::FittedLaw law;
};

input::Json series_json(const config::Configuration& model, const SeriesEnsembles& ensembles,
                        const selection::SeriesExplanation& found,
                        const std::vector<PerimeterExponent>& exponents);

Verdict verdict_of(const config::Configuration& model, const SeriesEnsembles& ensembles,
                   const selection::SeriesExplanation& found,
                   const selection::SeriesRequest& request);
// verdict.json, and model.toml if something was named: the model, here as its user gave it (in
// `model_file`, if not empty, and flags), with the effect that explains most and D. Throws IoError.
void write_series_verdict(const std::filesystem::path& folder,
                          const std::filesystem::path& model_file, const config::GivenValues& model,
                          const SeriesEnsembles& ensembles,
                          const selection::SeriesExplanation& found,
                          const selection::SeriesRequest& request);

}  // namespace traceraft::explain
