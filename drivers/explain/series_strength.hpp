// The strength of an effect that series tell, in the units of its user.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/explain/found_parameters.hpp"
#include "drivers/explain/series_ensembles.hpp"

namespace traceraft::explain {

// The units with the D of a fit.
physics::Units units_of(const config::Configuration& model, double ln_unit);

struct ToldStrength {
  std::string parameter, unit;
  double value, sigma;
  std::optional<double> low, high;  // 95 %; nothing where the data do not bound it
};
// Brownian flow is told as the viscosity of the membrane.
ToldStrength told_strength(const config::Configuration& model, const SeriesEnsembles& ensembles,
                           const selection::SeriesScore& score);

// The parameters of an effect that were not looked for, as they were simulated.
std::vector<FoundParameter> assumed_parameters(const config::Configuration& model,
                                               const SeriesEnsembles& ensembles,
                                               const selection::SeriesScore& score);

// The effect with the strength that fits best, or the nearest that it may have, for a model with
// the D of the same fit.
effects::EffectTerm found_term(const config::Configuration& model, const SeriesEnsembles& ensembles,
                               const selection::SeriesScore& score);

}  // namespace traceraft::explain
