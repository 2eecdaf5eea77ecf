// Published facts of measurements, from a TOML file (docs/formats.md).
#pragma once

#include <filesystem>

#include "verification/observations/published.hpp"

namespace traceraft::input {

// Throws InputError with file, line and key for what is missing, unknown or out of range.
observations::PublishedFacts read_facts(const std::filesystem::path& path);

}  // namespace traceraft::input
