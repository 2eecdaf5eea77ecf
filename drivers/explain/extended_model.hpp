// The user's model file with what was found in it.
#pragma once

#include <filesystem>

#include "drivers/config/configuration.hpp"

namespace traceraft::explain {

// The lines of `original` as they are, but for one block with every value of `wanted` that they do
// not have, after `heading`; nothing but the block if there is no such file (empty path). Throws
// IoError, and InputError for an original that is no model file.
void write_extended_model(const std::filesystem::path& file, const std::filesystem::path& original,
                          const config::GivenValues& wanted, const std::string& heading);

}  // namespace traceraft::explain
