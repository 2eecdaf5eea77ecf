// The vesicle of blind cases on the command line: by default the small one.
#pragma once

#include "drivers/campaign/hidden_case.hpp"
#include "drivers/config/option_flags.hpp"

namespace traceraft::campaign {

inline void add_vesicle_options(CLI::App& command, config::GivenValues& values) {
  config::GivenValues small;
  add_small_vesicle(small, "default");
  const auto wanted = [](const config::OptionSpec& spec) {
    return (spec.group == "Physics" || spec.name == "cells" || spec.name == "raft-fraction") &&
           spec.name != "scaled" && spec.name != "effect";
  };
  config::add_options(command, values, wanted, small);
}

}  // namespace traceraft::campaign
