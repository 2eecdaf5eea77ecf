// Measured vesicles from files: dataset.toml and a table (docs/formats.md).
#pragma once

#include <filesystem>

#include "verification/observations/measurements.hpp"

namespace traceraft::input {

// Checks everything and converts units. Throws InputError with file, line and column for what is
// missing, unknown or impossible.
observations::MeasuredVesicles read_dataset(const std::filesystem::path& folder);

// Writes measurements as such a folder. Throws IoError.
void write_dataset(const std::filesystem::path& folder, const observations::MeasuredVesicles& data,
                   const std::string& remark);

}  // namespace traceraft::input
