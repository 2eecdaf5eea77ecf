#include "drivers/input/model_of_data.hpp"

#include <cstdlib>

#include "drivers/config/cases.hpp"
#include "kernel/core/error.hpp"
#include "verification/observations/raft_fraction.hpp"

namespace traceraft::input {

std::string case_of(const std::string& composition) {
  if (composition.empty()) return "";
  for (const config::CaseEntry& entry : config::cases())
    if (!entry.composition.empty() && observations::same_membrane(composition, entry.composition))
      return entry.name;
  return "";
}

void refuse_without_model(const std::string& composition, const std::string& model,
                          const config::GivenValues& flags) {
  if (!model.empty() || flags.count("case") > 0) return;
  const std::string own = case_of(composition);
  throw InputError("--case or --model: a model is needed to compare the measurements with" +
                   (own.empty()
                        ? std::string()
                        : "; for their composition, " + composition + ", it is --case " + own));
}

std::string other_membrane(const std::string& composition, const config::Configuration& model) {
  if (composition.empty() || model.options().case_name.empty()) return "";
  const config::CaseEntry& entry = config::cases().find(model.options().case_name);
  if (entry.composition.empty() || observations::same_membrane(composition, entry.composition))
    return "";
  for (const auto& [option, value] : entry.values)
    if (option == "raft-fraction" &&
        model.options().raft_fraction != std::strtod(value.c_str(), nullptr))
      return "";
  return entry.composition + " (case " + entry.name +
         (model.given(&config::RunOptions::case_name) ? "" : ", by default") +
         "), but that of the measurements is " + composition;
}

}  // namespace traceraft::input
