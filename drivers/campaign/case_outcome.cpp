#include "drivers/campaign/case_outcome.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::campaign {
namespace {

std::vector<std::string> sorted_parts(const std::string& names) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = std::min(names.find(" + ", at), names.size());
    parts.push_back(names.substr(at, end - at));
    at = end + 3;
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace

std::string word_for(CaseOutcome outcome) {
  switch (outcome) {
    case CaseOutcome::right:
      return "right";
    case CaseOutcome::in_class:
      return "in class";
    case CaseOutcome::missed:
      return "missed";
    case CaseOutcome::wrong:
      return "wrong";
  }
  return "";
}

CaseOutcome outcome_of(const std::string& word) {
  for (const CaseOutcome outcome :
       {CaseOutcome::right, CaseOutcome::in_class, CaseOutcome::missed, CaseOutcome::wrong})
    if (word == word_for(outcome)) return outcome;
  throw InputError("a case of a campaign cannot end with '" + word + "'");
}

std::string names_of(const std::vector<effects::EffectTerm>& terms) {
  std::string names;
  for (const effects::EffectTerm& term : terms)
    names += (names.empty() ? "" : " + ") + assimilation::candidate_name(term);
  return names;
}

std::string in_order(const std::string& names) {
  return joined(sorted_parts(names), " + ");
}

CaseOutcome outcome_of(Aim aim, const std::string& hidden_names, const explain::Verdict& verdict) {
  const selection::Finding finding = verdict.finding;
  const bool named = selection::is_named(finding);
  if (aim == Aim::nothing)
    return named || finding == selection::Finding::unnamed ? CaseOutcome::wrong
           : finding == selection::Finding::none           ? CaseOutcome::right
                                                           : CaseOutcome::missed;
  if (aim == Aim::unnamed)
    return named                                    ? CaseOutcome::wrong
           : finding == selection::Finding::unnamed ? CaseOutcome::right
                                                    : CaseOutcome::missed;
  if (!named) return CaseOutcome::missed;
  const auto hidden = sorted_parts(hidden_names);
  const std::vector<std::string> found = sorted_parts(verdict.members.front());
  if (found == hidden)
    return finding == selection::Finding::named ? CaseOutcome::right : CaseOutcome::in_class;
  for (const std::string& equivalent : verdict.members)
    if (sorted_parts(equivalent) == hidden) return CaseOutcome::in_class;
  // A part of what was hidden, and nothing else, is no wrong name.
  return std::includes(hidden.begin(), hidden.end(), found.begin(), found.end())
             ? CaseOutcome::missed
             : CaseOutcome::wrong;
}

std::optional<StrengthError> strength_error(const HiddenTruth& truth, physics::Units units,
                                            const explain::Verdict& verdict) {
  if (truth.effects.empty() || !selection::is_named(verdict.finding)) return {};
  const effects::EffectTerm& term = truth.effects.front();
  const std::string name = assimilation::candidate_name(term);
  const std::size_t place = assimilation::find_candidate(name)->parameter;
  const ParameterSpec& strength = effects::effects().find(term.effect).parameters[place];
  const std::vector<explain::FoundParameter>& all = verdict.parameters;
  const auto found = std::find_if(all.begin(), all.end(), [&](const explain::FoundParameter& p) {
    return p.effect == name && p.name == strength.name;
  });
  if (found == all.end()) return {};
  // A gap that no strength reaches is one at the end of the range, where a search ends, too.
  const double hidden = term.values[place];
  if (strength.unit.empty() && (hidden <= strength.min || hidden >= strength.max)) return {};
  units.diffusion_cm2_s *= truth.diffusion_ratio;
  const double value = hidden / effects::to_model_units(strength.unit, units);
  const double difference = found->value - value;
  return StrengthError{std::fabs(difference / value), difference / found->sigma.value()};
}

}  // namespace traceraft::campaign
