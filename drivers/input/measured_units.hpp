// The units that data sets may be in, and what numbers in them are possible.
#pragma once

#include <optional>
#include <string>

#include "drivers/config/configuration.hpp"
#include "drivers/config/toml_table.hpp"

namespace traceraft::input {

// Does the key `kind` say "synthetic", not "measured"? Throws InputError for other words.
bool is_synthetic(const config::TomlTable& toml);
// The factor to µm or s of the unit that stands under a key. Throws InputError.
double length_factor(const config::TomlTable& toml, const std::string& key);
double time_factor(const config::TomlTable& toml, const std::string& key);
// The time to be added to all times, in the unit of the data. Throws InputError.
double time_offset(const config::TomlTable& toml);

// The composition and temperature (°C) of the membrane, "" and nothing if they are not said. Throw
// InputError.
std::string composition_of(const config::TomlTable& toml);
std::optional<double> celsius_of(const config::TomlTable& toml);

// In s after time zero, or in µm. Throw InputError, which begins with `where`, for what no vesicle
// has been looked at or measured to be.
double checked_time(double time, const std::string& where);
double checked_radius(double radius, const std::string& where);

// Throws InputError if the model that measurements are held against is in units of R and R²/D.
void refuse_scaled(const config::Configuration& model);

}  // namespace traceraft::input
