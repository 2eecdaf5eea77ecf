#include "drivers/input/measured_folder.hpp"

#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::input {
namespace {

namespace fs = std::filesystem;

config::TomlTable read_description(const fs::path& folder, bool fields, bool series) {
  std::vector<std::string> keys{"name",        "kind",      "origin",      "composition",
                                "temperature", "time_zero", "time_offset", "length_unit",
                                "time_unit",   "radius"};
  if (fields)
    keys.insert(keys.end(), {"blur", "noise_correlation", "noise_share", "times", "vesicles"});
  if (series) keys.insert(keys.end(), {"sigma", "table"});
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(folder.string() + " is a file; the folder that holds dataset.toml is needed");
  if (fs::is_directory(folder) && !fs::exists(folder / "dataset.toml") &&
      fs::exists(folder / "data" / "dataset.toml"))
    throw InputError(folder.string() + " holds no dataset.toml; did you mean '" +
                     (folder / "data").string() + "'?");
  return config::TomlTable::read(folder / "dataset.toml", keys);
}

}  // namespace

bool holds_fields(const fs::path& folder) {
  return fs::exists(folder / snapshot_file(1));
}

bool holds_series(const fs::path& folder) {
  if (fs::exists(folder / "measurements.csv")) return true;
  return fs::exists(folder / "dataset.toml") && read_description(folder, true, true).has("table");
}

config::TomlTable read_field_description(const fs::path& folder) {
  return read_description(folder, true, holds_series(folder));
}

config::TomlTable read_series_description(const fs::path& folder) {
  return read_description(folder, holds_fields(folder), true);
}

std::string snapshot_file(std::size_t number) {
  return formatted("snapshot_%03zu.csv", number);
}

bool is_snapshot_file(const fs::path& path) {
  const std::string begin = "snapshot_", digits = "0123456789", stem = path.stem().string();
  return path.extension() == ".csv" && stem.size() >= begin.size() + 3 &&
         stem.compare(0, begin.size(), begin) == 0 &&
         stem.find_first_not_of(digits, begin.size()) == std::string::npos &&
         fs::is_regular_file(fs::symlink_status(path));
}

}  // namespace traceraft::input
