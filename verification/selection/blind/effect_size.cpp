#include "verification/selection/blind/effect_size.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/named_list.hpp"
#include "kernel/core/random.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/assimilation/forecast/resolved_forecast.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::selection {
namespace {

// Standard deviation of c below which there is nothing to see.
constexpr double kLeastContrast = 0.01;

BlindLooks sizing_looks(BlindRequest request) {
  if (request.sizing_snapshots > 0) request.snapshots = request.sizing_snapshots;
  return BlindLooks(request);
}

}  // namespace

EffectSizing::EffectSizing(const BlindRequest& request)
    : request_(request), looks_(sizing_looks(request)) {
  constexpr double kCoarser = 0.7, kTolerance = 1e-3;
  const int cells =
      request.sizing_cells > 0 ? request.sizing_cells : static_cast<int>(kCoarser * request.cells);
  method_ = {assimilation::serial_space(looks_.surface, cells, request.base.mass_stabilisation),
             "ida", kTolerance};
  const BlindSimulation base(request_, method_, {});
  snapshots_ = base.run(looks_.times);
  for (std::size_t k = 0; k + 1 < snapshots_.size(); ++k)
    next_.push_back(base.advance(snapshots_[k], looks_.times[k], looks_.times[k + 1]));
  for (std::size_t k = 0; k < next_.size(); ++k)
    refuse_without_rafts(spread(*method_.space, snapshots_[k]));
}

effects::EffectTerm EffectSizing::term(const std::string& effect, std::uint64_t number) const {
  return term(effect, random_coefficients(candidate_to_hide(effect), number));
}

// A small one, then in proportion, twice.
effects::EffectTerm EffectSizing::term(const std::string& effect,
                                       std::vector<double> coefficients) const {
  const assimilation::Candidate candidate = candidate_to_hide(effect);
  for (int k = 0; k < 2; ++k) {
    const double change = request_.gap / gap_of(drawn_often(candidate.term(coefficients))),
                 ratio = candidate.random ? change * change : change;
    for (double& a : coefficients) a = candidate.within_range(ratio * a);
  }
  return drawn_often(candidate.term(coefficients));
}

std::vector<double> EffectSizing::random_coefficients(const assimilation::Candidate& candidate,
                                                      std::uint64_t number) const {
  std::vector<double> coefficients;
  for (int d = 0; d < candidate.directions; ++d) {
    const double u =
        uniform_random(request_.seed, statistics::stream::hidden_strength, 10 * number + d);
    const double sign = candidate.two_sided && u < 0.5 ? -1 : 1;
    coefficients.push_back(sign * candidate.step * (candidate.directions > 1 ? 0.2 + u : 1));
  }
  return coefficients;
}

// Brownian flow changes several times between snapshots.
effects::EffectTerm EffectSizing::drawn_often(effects::EffectTerm term) const {
  constexpr double kDraws = 10;
  if (assimilation::find_candidate(assimilation::candidate_name(term))->random)
    term.values[place_of("hold", effects::effects().find(term.effect).parameters)] =
        (request_.last - request_.first) / (request_.snapshots - 1) / kDraws;
  return term;
}

double EffectSizing::gap_of(const effects::EffectTerm& term) const {
  const BlindSimulation changed(request_, method_, {term});
  const fem::SurfaceSpace& space = *method_.space;
  double squares = 0;
  for (std::size_t k = 0; k < next_.size(); ++k) {
    const Vec difference =
        changed.advance(snapshots_[k], looks_.times[k], looks_.times[k + 1]) - next_[k];
    const double contrast = spread(space, snapshots_[k]);
    squares += space.inner(difference, difference) / space.area / (contrast * contrast);
  }
  return std::sqrt(squares / static_cast<double>(next_.size()));
}

assimilation::Candidate candidate_to_hide(const std::string& effect) {
  const auto valid = effects_to_hide(), known = effects::effects().names();
  if (std::find(valid.begin(), valid.end(), effect) == valid.end())
    throw InputError(std::find(known.begin(), known.end(), effect) != known.end()
                         ? "the effect " + effect +
                               " is not one that explain searches for on a sphere"
                         : unknown_name_message("effect to hide", effect, valid));
  return *assimilation::find_candidate(effect);
}

std::vector<std::string> effects_to_hide() {
  std::vector<std::string> names;
  for (const assimilation::Candidate& candidate : assimilation::candidates())
    if (candidate.name != "curvature") names.push_back(candidate.name);
  return names;
}

void refuse_without_rafts(double contrast) {
  if (contrast > kLeastContrast) return;
  throw InputError(
      "the base model has no rafts at these times; choose a larger raft fraction (smooth noise "
      "below 0.21 dissolves) or other times");
}

std::vector<effects::EffectTerm> size_effects(const BlindRequest& request) {
  std::vector<effects::EffectTerm> terms;
  if (request.effects.empty()) return terms;
  const EffectSizing sizing(request);
  for (std::size_t k = 0; k < request.effects.size(); ++k)
    terms.push_back(sizing.term(request.effects[k], k));
  return terms;
}

}  // namespace traceraft::selection
