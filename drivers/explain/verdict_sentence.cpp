#include "drivers/explain/verdict_sentence.hpp"

#include <cmath>

#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::explain {
namespace {

// "rafts that repel each other over a distance; ...": of the effects that it adds.
std::string in_words(const assimilation::Hypothesis& hypothesis) {
  std::string words;
  for (std::size_t k = hypothesis.known; k < hypothesis.parts.size(); ++k)
    words += (words.empty() ? "" : "; ") + assimilation::physics_of(hypothesis.parts[k]);
  return words;
}

// A model that on another mesh foretells no better than the base may be none, and so may one that
// could not be looked at.
std::string lacks(const selection::Explanation& found) {
  const bool doubtful = found.rerun && found.rerun->failure.empty() && !found.rerun->confirms();
  return doubtful || !found.stopped.empty() ? "The model may lack " : "The model lacks ";
}

std::string class_sentence(const selection::Explanation& found) {
  std::string others;
  for (const selection::Refit& fit : found.rivals)
    others += ", or " + fit.hypothesis.name() + " (" + in_words(fit.hypothesis) + ")";
  return lacks(found) + found.found.hypothesis.name() + " (" + in_words(found.found.hypothesis) +
         ")" + others +
         ". These data do not separate them. Numbers and figures are those of the first.";
}

std::string nothing_sentence(const selection::Explanation& found) {
  std::vector<std::string> changes;
  if (changes_diffusion_ratio(found.found))
    changes.push_back(formatted("%.3g times its D", found.found.diffusion_ratio));
  if (!found.found.hypothesis.parts.empty())
    changes.push_back("the fitted strengths of its effects");
  return "No significant disagreement: " +
         (changes.empty() ? "" : "with " + joined(changes, " and ") + " ") +
         "the model explains the data within their noise.";
}

// An effect that closes next to nothing of the gap is not close to the truth.
bool closes_something(const selection::Explanation& found, const selection::Refit& fit) {
  constexpr double kLeast = 0.1;
  const assimilation::SharesClosed closed = selection::shares_closed(found.base, fit);
  return closed.heldout.value_or(closed.train.value_or(0)) >= kLeast;
}

// The likeliest of single effects, refitted if any was.
std::string likeliest(const selection::Explanation& found) {
  const selection::Round& first = found.rounds.front();
  return first.refits.empty() ? first.screening.scores.front().effect
                              : first.refits.front().hypothesis.name();
}

std::string doubt_sentence(const selection::Explanation& found) {
  if (found.at_rest)
    return "The rafts are at rest: from snapshot to snapshot nothing changes beyond noise and "
           "rotation. The model forecasts the same with a tenth of its D and with ten times its D. "
           "Kinetics were therefore not tested, and no effect was searched for. Take snapshots at "
           "times at which rafts still change.";
  const selection::Screening& first = found.rounds.front().screening;
  if (found.rerun && found.rerun->refutes())
    return "Something seems to be missing. " + found.found.hypothesis.name() +
           " seemed to explain it, but a check on another mesh with another integrator refutes "
           "this.";
  if (first.p <= found.false_alarms)
    return "Something seems to be missing, but too little to say what. " + likeliest(found) +
           " would explain most of it. More points, less noise or more snapshots would decide.";
  if (!selection::tests_kinetics(found.base))
    return formatted(
        "No significant disagreement, but kinetics were not tested: these data determine D only to "
        "a factor of %.2g. Several snapshots from times at which rafts still change would test "
        "them.",
        std::exp(statistics::kNormal95 * found.base.diffusion_ratio_deviation));
  return "No significant disagreement, but these data would hardly show an effect. More points, "
         "less noise or longer times between snapshots would help.";
}

}  // namespace

std::string comes_closest(const selection::Explanation& found) {
  if (found.finding != selection::Finding::unnamed) return "";
  const selection::Round& first = found.rounds.front();
  const bool added = found.found.hypothesis.added() > 0;
  if (!added && first.refits.empty()) return "";
  const selection::Refit& best = added ? found.found : first.refits.front();
  const bool gains = added || first.without.deviance - best.deviance > selection::kTelling;
  return gains && closes_something(found, best) ? best.hypothesis.name() : "";
}

bool changes_diffusion_ratio(const selection::Refit& fit) {
  constexpr double kLeast = 0.01;  // of D: what no mesh is better than
  return std::fabs(std::log(fit.diffusion_ratio)) >
         std::max(kLeast, kSure * fit.diffusion_ratio_deviation);
}

std::string verdict_words(selection::Finding finding, const std::vector<std::string>& effects) {
  return selection::word_for(finding) + (effects.empty() ? "" : " (" + joined(effects, ", ") + ")");
}

std::string verdict_sentence(const selection::Explanation& found) {
  const std::string name = found.found.hypothesis.name(), closest = comes_closest(found);
  switch (found.finding) {
    case selection::Finding::none:
      return nothing_sentence(found);
    case selection::Finding::named:
      return lacks(found) + name + ": " + in_words(found.found.hypothesis) + ".";
    case selection::Finding::ambiguous:
      return class_sentence(found);
    case selection::Finding::below_resolution:
      return std::string(found.disagreements.empty()
                             ? "An effect would improve the forecasts, though no single region "
                               "disagrees beyond noise. The"
                             : "There is a disagreement, but the") +
             " error of the model's mesh could explain all of it. Repeat with more --cells.";
    case selection::Finding::not_identifiable:
      return doubt_sentence(found);
    case selection::Finding::unnamed:
      return (found.disagreements.empty()
                  ? "Measurements and forecasts disagree over the whole vesicle, but in no single "
                    "region beyond noise. None of the effects in the search explains this"
                  : "There is a disagreement that none of the effects in the search explains") +
             (closest.empty() ? "; none comes close." : "; " + closest + " comes closest.");
  }
  return "";
}

}  // namespace traceraft::explain
