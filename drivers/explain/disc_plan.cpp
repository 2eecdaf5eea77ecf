#include "drivers/explain/disc_plan.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/run/physical_model.hpp"
#include "kernel/core/text.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/series/brownian_viscosity.hpp"
#include "verification/selection/series/series_size.hpp"

namespace traceraft::explain {
namespace {

// Viscosities of membranes (nPa s m): DOPC has 4.1 ± 2.6, SOPC 9.7 ± 5.8; levels are for all of
// kLeast to kLargest, at D of the model from kFastest times to 1/kSlowest of it.
constexpr double kTypical = 4, kLeast = 1, kLargest = 100, kFastest = 4, kSlowest = 1000;

}  // namespace

DiscSizes::DiscSizes(const config::Configuration& model, const SeriesPlanRequest& request)
    : model_(model), request_(request) {
  const problem::CahnHilliardModel base = run::model_without_effects(model);
  for (const assimilation::Candidate& candidate : assimilation::candidates())
    if (candidate.directions == 1 && !candidate.random &&
        effects::discs_can_have(candidate.term({candidate.step}), base))
      effects_.push_back(candidate.name);
}

std::optional<PlannedEffect> DiscSizes::find(std::size_t k) const {
  return effects_[k] == "flow" ? brownian_levels() : by_response(effects_[k]);
}

// Steps of a factor e, so that the strength depends smoothly on the amplitude of a fit. The drag of
// the water is that of a typical viscosity.
PlannedEffect DiscSizes::brownian_levels() const {
  const physics::Units units = model_.units();
  const double water = selection::drag_of_water(kTypical, units), step = std::exp(1.0),
               least = selection::thermal_of(kFastest * kLargest, request_.kelvin, units),
               most = selection::thermal_of(kLeast / kSlowest, request_.kelvin, units);
  PlannedEffect planned;
  for (double thermal = least; thermal < step * most; thermal *= step)
    planned.levels.push_back(selection::flow_with({0, water, thermal}, units));
  return planned;
}

// A small strength, then in proportion.
std::optional<PlannedEffect> DiscSizes::by_response(const std::string& effect) const {
  constexpr double kChange = 0.2, kNear = 1.6, kLargestFactor = 30, kWeaker = 0.1;
  constexpr int kMostTrials = 6;
  const assimilation::Candidate candidate = *assimilation::find_candidate(effect);
  const double unit = model_.units().time();
  const statistics::Window looks{request_.looks.begin / unit, request_.looks.end / unit};
  const ensemble::PointEnd base = request_.simulate("none", nullptr);
  if (base.stopped) return std::nullopt;
  double a = candidate.rate ? candidate.step / looks.end : candidate.step;
  for (int k = 0; k < kMostTrials; ++k) {
    const effects::EffectTerm term = candidate.term({a});
    const ensemble::PointEnd end =
        request_.simulate(formatted("%s-%d", effect.c_str(), k + 1), &term);
    if (end.stopped) return std::nullopt;
    const bool failed = !end.failures.empty() || !base.failures.empty();
    const double change = failed ? 0 : selection::series_change(base.runs, end.runs, looks);
    const double factor = failed ? kWeaker : std::clamp(kChange / change, kWeaker, kLargestFactor);
    if (factor < kNear && factor > 1 / kNear) break;
    const double next = candidate.within_range(factor * a);
    if (next == a) break;
    a = next;
  }
  return PlannedEffect{{candidate.term({a})}};
}

std::size_t typical_level(const PlannedEffect& planned, const config::Configuration& model,
                          const SeriesPlanRequest& request) {
  if (planned.levels.size() == 1) return 0;
  const double typical = selection::thermal_of(kTypical, request.kelvin, model.units());
  std::size_t best = 0;
  for (std::size_t k = 0; k < planned.levels.size(); ++k)
    if (std::fabs(std::log(planned.strength(k) / typical)) <
        std::fabs(std::log(planned.strength(best) / typical)))
      best = k;
  return best;
}

}  // namespace traceraft::explain
