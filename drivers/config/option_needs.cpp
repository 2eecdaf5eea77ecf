#include "drivers/config/option_needs.hpp"

#include <algorithm>

#include "backends/list.hpp"
#include "drivers/config/options.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::config {
namespace {

struct OptionNeed {
  std::string option, chooser;       // "noise-cells", "initial"
  std::vector<std::string> choices;  // any of them makes it count
};

std::vector<OptionNeed> all_needs() {
  std::vector<OptionNeed> needs = {
      {"initial-formula", "initial", {"formula"}},
      {"initial-caps", "initial", {"caps"}},
      {"raft-fraction", "initial", {"noise", "band-limited", "discs"}},
      {"noise-cells", "initial", {"noise"}},
      {"keep", "integrator", {"euler"}},
      {"mesh-levels", "mesh", {"adaptive"}},
      {"mesh-threshold", "mesh", {"adaptive"}},
  };
  for (const char* option :
       {"surface-formula", "mesh", "cells-per-boundary", "potential", "stabilisation",
        "mass-stabilisation", "noise-cells", "integrator", "initial-step", "min-step", "max-step",
        "keep", "energy-guard", "linear-solver", "linear-tolerance"})
    needs.push_back({option, "model", {"field"}});
  for (const backends::IntegratorEntry& integrator : backends::integrators())
    for (const ParameterSpec& parameter : integrator.parameters)
      needs.push_back({method_option(integrator.name, parameter), "integrator", {integrator.name}});
  for (const backends::LinearSolverEntry& solver : backends::linear_solvers())
    for (const ParameterSpec& parameter : solver.parameters)
      needs.push_back({method_option(solver.name, parameter), "linear-solver", {solver.name}});
  return needs;
}

const std::vector<OptionNeed>& option_needs() {
  static const std::vector<OptionNeed> needs = all_needs();
  return needs;
}

bool met(const OptionNeed& need, const std::vector<std::string>& chosen) {
  return std::find_first_of(chosen.begin(), chosen.end(), need.choices.begin(),
                            need.choices.end()) != chosen.end();
}

std::vector<std::string> chosen(const Configuration& configuration, const std::string& chooser) {
  return {split_named_arguments(configuration.text(chooser)).name};
}

}  // namespace

bool is_idle(const Configuration& configuration, const std::string& option) {
  return std::any_of(option_needs().begin(), option_needs().end(), [&](const OptionNeed& need) {
    return need.option == option && !met(need, chosen(configuration, need.chooser));
  });
}

void refuse_idle_options(const Configuration& configuration, const Compared& compared) {
  for (const OptionNeed& need : option_needs()) {
    if (!configuration.given(need.option)) continue;
    const auto several = compared.find(need.chooser);
    const bool one = several == compared.end();
    if (met(need, one ? chosen(configuration, need.chooser) : several->second)) continue;
    if (configuration.from_flag(need.option) || (one && !configuration.given(need.chooser)))
      throw InputError(configuration.where(need.option) + ": it needs --" + need.chooser +
                       (one ? " " : "s ") + joined(need.choices, " or "));
  }
}

}  // namespace traceraft::config
