// Whether a verdict is right, given what was hidden.
#pragma once

#include <optional>
#include <string>

#include "drivers/campaign/campaign_groups.hpp"
#include "drivers/campaign/hidden_case.hpp"
#include "drivers/explain/verdict.hpp"

namespace traceraft::campaign {

enum class CaseOutcome {
  right,     // what was hidden was named, and nothing else; or nothing where that is the aim
  in_class,  // a class was declared that holds it
  missed,    // no name where there is one, or a part of the name; a doubt where there is nothing
  wrong      // another name, or a disagreement where there is none
};
std::string word_for(CaseOutcome outcome);
CaseOutcome outcome_of(const std::string& word);  // throws InputError for other words

// Names joined by " + ".
std::string names_of(const std::vector<effects::EffectTerm>& terms);
// The same in the order of the alphabet, so that it does not matter which was hidden, or found,
// first.
std::string in_order(const std::string& names);

// `hidden`: names_of the truth.
CaseOutcome outcome_of(Aim aim, const std::string& hidden, const explain::Verdict& verdict);

// The error of the first hidden effect's strength, if the verdict has it and it is not at the end
// of its range; relative, and in the standard deviations that the verdict says. `units`: of the
// model.
struct StrengthError {
  double relative, deviations;
};
std::optional<StrengthError> strength_error(const HiddenTruth& truth, physics::Units units,
                                            const explain::Verdict& verdict);

}  // namespace traceraft::campaign
