// The units that data sets may be in.
#pragma once

#include <string>

#include "drivers/input/toml_table.hpp"

namespace traceraft {

// The factor to µm or s of the unit that stands under a key. Throws InputError.
double length_factor(const TomlTable& toml, const std::string& key);
double time_factor(const TomlTable& toml, const std::string& key);

}  // namespace traceraft
