#include "drivers/explain/series_strength.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "verification/selection/series/brownian_viscosity.hpp"

namespace traceraft::explain {
namespace {

const PlannedEffect& planned_of(const SeriesEnsembles& ensembles, const std::string& effect) {
  for (const PlannedEffect& planned : ensembles.effects)
    if (planned.effect() == effect) return planned;
  throw std::logic_error("no simulations with " + effect);
}

const ParameterSpec& sought_of(const PlannedEffect& planned) {
  return effects::effects().find(planned.effect()).parameters[planned.sought()];
}

// Is the strength the one of Brownian motion?
bool is_brownian(const PlannedEffect& planned) {
  return planned.effect() == "flow" && sought_of(planned).name == "thermal";
}

double told_viscosity(const PlannedEffect& planned, const SeriesEnsembles& ensembles,
                      double thermal, const physics::Units& units) {
  return selection::viscosity_of(thermal, selection::membrane_of(planned.levels.front()).water,
                                 ensembles.kelvin, units);
}

// The more viscous, the weaker the motion.
ToldStrength viscosity_told(const PlannedEffect& planned, const SeriesEnsembles& ensembles,
                            const selection::SeriesScore& score, const physics::Units& units) {
  const auto viscosity = [&](double thermal) {
    return told_viscosity(planned, ensembles, thermal, units);
  };
  ToldStrength told{"membrane-viscosity", "nPa s m", viscosity(score.value), 0, {}, {}};
  told.sigma = told.value * score.sigma / score.value;
  if (score.bounded) told.low = viscosity(score.high);
  if (score.bounded && score.low > 0) told.high = viscosity(score.low);
  return told;
}

}  // namespace

physics::Units units_of(const config::Configuration& model, double ln_unit) {
  return model.units().with_seconds_per_unit(std::exp(ln_unit));
}

ToldStrength told_strength(const config::Configuration& model, const SeriesEnsembles& ensembles,
                           const selection::SeriesScore& score) {
  const PlannedEffect& planned = planned_of(ensembles, score.effect);
  const physics::Units units = units_of(model, score.ln_unit);
  if (is_brownian(planned) && score.value > 0)
    return viscosity_told(planned, ensembles, score, units);
  const ParameterSpec& spec = sought_of(planned);
  const double factor = 1 / effects::to_model_units(spec.unit, units);
  ToldStrength told{spec.name, spec.unit, factor * score.value, factor * score.sigma, {}, {}};
  if (score.bounded) {
    told.low = factor * score.low;
    told.high = factor * score.high;
  }
  return told;
}

std::vector<FoundParameter> assumed_parameters(const config::Configuration& model,
                                               const SeriesEnsembles& ensembles,
                                               const selection::SeriesScore& score) {
  const PlannedEffect& planned = planned_of(ensembles, score.effect);
  const physics::Units units = units_of(model, score.ln_unit);
  if (!is_brownian(planned)) {
    std::vector<FoundParameter> all = parameters_of(planned.levels.front(), units);
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(planned.sought()));
    return all;
  }
  std::vector<FoundParameter> assumed;
  for (FoundParameter& p :
       parameters_of(selection::brownian_flow(1, ensembles.kelvin, units), units))
    if (p.name == "temperature" || p.name == "water-viscosity") assumed.push_back(std::move(p));
  return assumed;
}

effects::EffectTerm found_term(const config::Configuration& model, const SeriesEnsembles& ensembles,
                               const selection::SeriesScore& score) {
  const PlannedEffect& planned = planned_of(ensembles, score.effect);
  const physics::Units units = units_of(model, score.ln_unit);
  if (is_brownian(planned))
    return selection::brownian_flow(told_viscosity(planned, ensembles, score.value, units),
                                    ensembles.kelvin, units);
  effects::EffectTerm term = planned.levels.front();
  term.values[planned.sought()] = score.value;
  return within_range(std::move(term), planned.sought(), units);
}

}  // namespace traceraft::explain
