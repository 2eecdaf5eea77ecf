// Configuration files: TOML with the names of the flags as keys.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"

namespace traceraft::config {

// An empty path: no file, no values. Throws InputError with file and line for anything that is no
// flat TOML table of known options. `flag`: that names the file.
GivenValues read_config_file(const std::filesystem::path& path,
                             const std::string& flag = "--config");

// A TOML file, or a word of the option `model` in place of one.
bool is_model_word(const std::string& file_or_word);
GivenValues read_model(const std::string& file_or_word);

// All options with their resolved values, each with its meaning: reads back as the same run.
std::string config_text(const Configuration& configuration);

// The lines of some of them.
std::string config_lines(const Configuration& configuration, const std::vector<std::string>& names);

// The flags that give the same numbers, as one would type them: those that are no defaults, without
// the leading space.
std::string flags_text(const Configuration& configuration);

// The options that decide the numbers of a run, in a normal form: equal text, equal run.
std::string numerical_identity(const Configuration& configuration);

// Names of those in which two runs differ.
std::vector<std::string> differing_options(const Configuration& a, const Configuration& b);

}  // namespace traceraft::config
