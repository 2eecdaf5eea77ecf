#include "verification/selection/search/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::selection {
namespace {

// Would any effect of the usual size have been seen?
bool identifiable(const Screening& screening, double usual_change) {
  return std::any_of(
      screening.scores.begin(), screening.scores.end(),
      [&](const CandidateScore& score) { return kSeen * score.resolution <= usual_change; });
}

// An effect of strength 0 is none: without it this is another hypothesis.
bool has_nothing(const assimilation::Hypothesis& hypothesis) {
  const auto known = static_cast<std::ptrdiff_t>(hypothesis.known);
  return std::any_of(hypothesis.parts.begin() + known, hypothesis.parts.end(),
                     [](const assimilation::Hypothesis::Part& part) {
                       return std::all_of(part.coefficients.begin(), part.coefficients.end(),
                                          [](double coefficient) { return coefficient == 0; });
                     });
}

}  // namespace

bool has_gap(const Screening& screening, double false_alarms) {
  return screening.gap_p <= kGapLevel * false_alarms;
}

std::string word_for(Finding finding) {
  switch (finding) {
    case Finding::none:
      return "none";
    case Finding::named:
      return "named";
    case Finding::ambiguous:
      return "ambiguous";
    case Finding::below_resolution:
      return "below-solver-resolution";
    case Finding::not_identifiable:
      return "not-identifiable";
    case Finding::unnamed:
      return "unnamed";
  }
  return "";
}

const std::string& last_effect(const assimilation::Hypothesis& hypothesis) {
  return hypothesis.parts.back().candidate.name;
}

double mesh_doubt(double values, double mesh_error) {
  return assimilation::kMeshDoubt * mesh_error * std::sqrt(values);
}

double discrimination_limit(double values, double mesh_error) {
  const double noise_and_mesh = std::sqrt(kTelling) + mesh_doubt(values, mesh_error);
  return noise_and_mesh * noise_and_mesh;
}

bool resolved(const Refit& fit, std::size_t effect, double values, double mesh_error) {
  return certainty(fit, effect) >= discrimination_limit(values, mesh_error);
}

bool all_resolved(const Refit& fit, double values, double mesh_error) {
  for (std::size_t k = fit.hypothesis.known; k < fit.hypothesis.parts.size(); ++k)
    if (!resolved(fit, k, values, mesh_error)) return false;
  return true;
}

double criterion(const Refit& fit, double values) {
  return fit.deviance + std::log(values) * static_cast<double>(fit.hypothesis.coefficients());
}

bool is_no_other(const Refit& fit, const Refit& best) {
  constexpr double kUseless = 2;
  return fit.hypothesis.contains(best.hypothesis) && best.deviance - fit.deviance < kUseless;
}

bool explains_as_well(const Refit& fit, const Refit& best, double values, double limit) {
  return !has_nothing(fit.hypothesis) && !is_no_other(fit, best) &&
         criterion(fit, values) < criterion(best, values) + limit;
}

Finding without_name(const Screening& screening, double false_alarms) {
  return has_gap(screening, false_alarms) ? Finding::unnamed : Finding::not_identifiable;
}

Judgement judge(const Round& round, double values, double false_alarms, double usual_change,
                const std::function<bool(const Refit&)>& leaves_gap) {
  const bool first = round.known.hypothesis.added() == 0;
  const bool quiet = round.screening.p > false_alarms;
  // The finding if nothing is added and there is no gap of any shape.
  const Finding no_gap =
      !first ? Finding::named
      : quiet && identifiable(round.screening, usual_change) && tests_kinetics(round.without)
          ? Finding::none
          : Finding::not_identifiable;
  const Judgement rest{
      false, has_gap(round.screening, false_alarms) ? Finding::unnamed : no_gap, no_gap, {}};
  if (round.refits.empty()) return rest;
  const Refit& best = round.refits.front();
  if (criterion(round.without, values) < criterion(best, values)) return rest;
  const std::size_t last = best.hypothesis.parts.size() - 1;
  if (!resolved(best, last, values, round.screening.mesh_error)) {
    if (!first) return rest;
    // No finer mesh would tell what noise hides.
    if (certainty(best, last) < kTelling)
      return {false, without_name(round.screening, false_alarms), Finding::not_identifiable, {}};
    const bool more = has_gap(round.screening, false_alarms) && leaves_gap(best);
    return {
        false, more ? Finding::unnamed : Finding::below_resolution, Finding::below_resolution, {}};
  }
  Judgement taken{true, Finding::named, Finding::named, {best.hypothesis.name()}};
  const double limit = discrimination_limit(values, round.screening.mesh_error);
  for (std::size_t k = 1; k < round.refits.size(); ++k)
    if (explains_as_well(round.refits[k], best, values, limit))
      taken.equivalent.push_back(round.refits[k].hypothesis.name());
  if (taken.equivalent.size() > 1) taken.finding = taken.without_gap = Finding::ambiguous;
  return taken;
}

}  // namespace traceraft::selection
