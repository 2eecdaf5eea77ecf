#include "verification/explain/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft {
namespace {

// An effect has to change c by that many times what extrapolation to finer meshes does.
constexpr double kResolved = 3;

// To the coefficients of a refit, of which there may be two: those of exchange are known to first
// order, as its term is linear in c.
double response_to(const Hypothesis::Part& part, const CandidateScore& score) {
  if (part.coefficients.size() > 1 || !std::isfinite(score.resolution)) return score.response;
  const double deviation = std::sqrt(score.covariance(0, 0));
  return std::fabs(part.coefficients[0]) / deviation * score.resolution;
}

bool resolved_in(const Round& round, const Hypothesis::Part& part) {
  return std::any_of(round.screening.scores.begin(), round.screening.scores.end(),
                     [&](const CandidateScore& score) {
                       return score.effect == part.candidate.effect &&
                              response_to(part, score) >= kResolved * round.screening.mesh_error;
                     });
}

// Would any effect of the usual size have been seen?
bool identifiable(const Screening& screening, double usual_change) {
  return std::any_of(
      screening.scores.begin(), screening.scores.end(),
      [&](const CandidateScore& score) { return kSeen * score.resolution <= usual_change; });
}

}  // namespace

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

const std::string& last_effect(const Hypothesis& hypothesis) {
  return hypothesis.parts.back().candidate.effect;
}

bool resolved(const std::vector<Round>& rounds, const Hypothesis& hypothesis) {
  return std::all_of(hypothesis.parts.begin(), hypothesis.parts.end(), [&](const auto& part) {
    return std::any_of(rounds.begin(), rounds.end(),
                       [&](const Round& round) { return resolved_in(round, part); });
  });
}

double criterion(const Refit& fit, double values) {
  return fit.deviance + std::log(values) * static_cast<double>(fit.hypothesis.coefficients());
}

Judgement judge(const Round& round, double values, double false_alarms, double usual_change) {
  const bool first = round.known.hypothesis.parts.empty();
  const bool quiet = round.screening.p > false_alarms;
  // What follows if nothing is added.
  const Finding rest = round.screening.gap_p <= kGapLevel * false_alarms ? Finding::unnamed
                       : !first                                          ? Finding::named
                       : quiet && identifiable(round.screening, usual_change)
                           ? Finding::none
                           : Finding::not_identifiable;
  if (round.refits.empty()) return {false, rest, {}};
  const Refit& best = round.refits.front();
  const double least = criterion(best, values);
  if (criterion(round.without, values) < least) return {false, rest, {}};
  if (!resolved_in(round, best.hypothesis.parts.back()))
    return {false, first ? Finding::below_resolution : rest, {}};
  Judgement taken{true, Finding::named, {best.hypothesis.name()}};
  for (std::size_t k = 1; k < round.refits.size(); ++k)
    if (criterion(round.refits[k], values) < least + kTelling)
      taken.equivalent.push_back(round.refits[k].hypothesis.name());
  if (taken.equivalent.size() > 1) taken.finding = Finding::ambiguous;
  return taken;
}

}  // namespace traceraft
