#include "verification/selection/search/neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::selection {
namespace {

// An effect came near another one if it gained at least this share of the deviance that the other
// one gained when it was taken.
constexpr double kNear = 0.5;
// The certainty of an effect that may stay, over what the criterion asks. Certainties are of the
// linearised model, and the model is not linear.
constexpr double kCertain = 2;

// The effects that came near this one in the rounds in which it was refitted.
std::vector<assimilation::Hypothesis::Part> rivals(const std::string& effect,
                                                   const std::vector<Round>& rounds) {
  std::vector<assimilation::Hypothesis::Part> result;
  for (const Round& round : rounds) {
    const auto is = [](const std::string& name) {
      return
          [name](const Refit& fit) { return fit.hypothesis.parts.back().candidate.name == name; };
    };
    const auto own = std::find_if(round.refits.begin(), round.refits.end(), is(effect));
    if (own == round.refits.end()) continue;
    const double gained = round.without.deviance - own->deviance;
    for (const Refit& fit : round.refits)
      if (!is(effect)(fit) && round.without.deviance - fit.deviance >= kNear * gained)
        result.push_back(fit.hypothesis.parts.back());
  }
  return result;
}

}  // namespace

std::vector<assimilation::Hypothesis> neighbours(
    const Refit& fit, const std::vector<Round>& rounds, double values,
    const std::vector<assimilation::Candidate>& allowed) {
  std::vector<assimilation::Hypothesis> result;
  const assimilation::Hypothesis& here = fit.hypothesis;
  const auto may_be_taken = [&](const std::string& effect) {
    return !here.has(effect) &&
           std::any_of(allowed.begin(), allowed.end(),
                       [&](const assimilation::Candidate& c) { return c.name == effect; });
  };
  for (std::size_t k = here.known; k < here.parts.size(); ++k) {
    const assimilation::Candidate& own = here.parts[k].candidate;
    if (here.added() > 1 && certainty(fit, k) < kCertain * own.directions * std::log(values)) {
      result.push_back(here);
      result.back().parts.erase(result.back().parts.begin() + static_cast<std::ptrdiff_t>(k));
    }
    std::vector<std::string> tried;
    for (const assimilation::Hypothesis::Part& rival : rivals(own.name, rounds)) {
      const std::string& effect = rival.candidate.name;
      if (!may_be_taken(effect) || std::count(tried.begin(), tried.end(), effect) > 0) continue;
      tried.push_back(effect);
      result.push_back(here);
      result.back().parts[k] = rival;
    }
  }
  return result;
}

}  // namespace traceraft::selection
