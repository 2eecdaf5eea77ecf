// Measured fields from files: dataset.toml and a table of points per snapshot (docs/formats.md).
#pragma once

#include <filesystem>
#include <optional>

#include "verification/explain/field_series.hpp"

namespace traceraft {

struct FieldDataset {
  std::string name, origin, time_zero;
  bool synthetic = false;
  double radius_um = 0;
  std::optional<double> blur_um;      // standard deviation of the point spread function
  std::vector<FieldSeries> vesicles;  // times in s, places in units of the radius
};

bool holds_fields(const std::filesystem::path& folder);

// Checks everything and converts units. Throws InputError with file, line and column for what is
// missing, unknown or impossible.
FieldDataset read_field_dataset(const std::filesystem::path& folder);

// Of a data set, counted over all its vesicles from 1 on.
std::string snapshot_file(std::size_t number);

// Writes such a folder, the tables first. Throws IoError.
void write_field_dataset(const std::filesystem::path& folder, const FieldDataset& data,
                         const std::string& remark);

}  // namespace traceraft
