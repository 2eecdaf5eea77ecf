// The units that data sets may be in.
#pragma once

#include <string>

#include "drivers/config/configuration.hpp"
#include "drivers/input/toml_table.hpp"

namespace traceraft {

// The factor to µm or s of the unit that stands under a key. Throws InputError.
double length_factor(const TomlTable& toml, const std::string& key);
// Of the key `kind`: "measured" or "synthetic". Throws InputError for other words.
bool is_synthetic(const TomlTable& toml);
double time_factor(const TomlTable& toml, const std::string& key);
// What has to be added to all times, in the unit of the data. Throws InputError.
double time_offset(const TomlTable& toml);

// Throws InputError if the model that measurements are held against is in units of R and R²/D.
void refuse_scaled(const Configuration& model);

}  // namespace traceraft
