// The measurements that a folder holds, and its description, dataset.toml (docs/formats.md).
#pragma once

#include <filesystem>

#include "drivers/config/toml_table.hpp"

namespace traceraft::input {

// snapshot_001.csv, ...
bool holds_fields(const std::filesystem::path& folder);
// measurements.csv, or another table that dataset.toml names.
bool holds_series(const std::filesystem::path& folder);

// The description of fields, or of series. One file describes both if a folder holds both. Throw
// InputError.
config::TomlTable read_field_description(const std::filesystem::path& folder);
config::TomlTable read_series_description(const std::filesystem::path& folder);

// The name of a snapshot's file in a folder of fields, counted over all its vesicles from 1 on.
std::string snapshot_file(std::size_t number);
// Is it a file of such a name?
bool is_snapshot_file(const std::filesystem::path& path);

}  // namespace traceraft::input
