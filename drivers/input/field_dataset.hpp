// Measured fields from files: dataset.toml and a table of points per snapshot (docs/formats.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drivers/input/measured_folder.hpp"
#include "verification/assimilation/fields/field_series.hpp"

namespace traceraft::input {

// The widest blur, over the radius: images that are blurred more show nothing.
inline constexpr double kWidestBlur = 0.2;
// In distances of the wells: values that are further from both are none of a membrane.
inline constexpr double kFarFromWells = 5;

struct FieldDataset {
  std::string name, origin, time_zero, composition;
  bool synthetic = false;
  double radius_um = 0;
  std::optional<double> blur_um;  // standard deviation of the point spread function
  // Over which length neighbours share noise, in um, and which part of its variance; both or none.
  double noise_correlation_um = 0, noise_share = 0;
  std::vector<assimilation::FieldSeries> vesicles;  // times in s, places in units of the radius
};

// Checks everything and converts units. Throws InputError with file, line and column for what is
// missing, unknown or impossible.
FieldDataset read_field_dataset(const std::filesystem::path& folder);

// "snapshot_002.csv:9: column 'c'" of a row of the second snapshot, 0 being the first one; without
// a column the line alone.
std::string place_of(const std::filesystem::path& folder, std::size_t snapshot, std::size_t row,
                     const std::string& column = "");

// If half of the points are further from the sphere of that radius, on the same side, than any
// measurement is off by chance: a sentence, else "".
std::string note_on_distance(const FieldDataset& data);

// If more of the values lie far from the phases a and b than noise would put there: a sentence,
// else "".
std::string note_on_scale(const FieldDataset& data, double a, double b);

// Writes such a folder, the tables first. Throws IoError.
void write_field_dataset(const std::filesystem::path& folder, const FieldDataset& data,
                         const std::string& remark);

}  // namespace traceraft::input
