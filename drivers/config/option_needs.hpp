// Options that count only where another one is chosen.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"

namespace traceraft::config {

// Where runs are compared, all that some option chooses in them.
using Compared = std::map<std::string, std::vector<std::string>>;

// Does the option nothing?
bool is_idle(const Configuration& configuration, const std::string& option);

// Refuses an option that does nothing: it is a mistake, not something to ignore. Files may hold it
// beside another choice. Throws InputError.
void refuse_idle_options(const Configuration& configuration, const Compared& compared = {});

}  // namespace traceraft::config
