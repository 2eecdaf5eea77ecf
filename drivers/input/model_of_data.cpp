#include "drivers/input/model_of_data.hpp"

#include "drivers/config/cases.hpp"
#include "kernel/core/error.hpp"
#include "verification/vesicles/raft_fraction.hpp"

namespace traceraft {

std::string case_of(const std::string& composition) {
  if (composition.empty()) return "";
  for (const CaseEntry& entry : cases())
    if (!entry.composition.empty() && same_membrane(composition, entry.composition))
      return entry.name;
  return "";
}

void refuse_without_model(const std::string& composition, const std::string& model,
                          const GivenValues& flags) {
  if (!model.empty() || flags.count("case") > 0) return;
  const std::string own = case_of(composition);
  throw InputError(
      "--case or --model: say which model to hold the measurements against" +
      (own.empty() ? std::string() : "; theirs, " + composition + ", is --case " + own));
}

}  // namespace traceraft
