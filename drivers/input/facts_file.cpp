#include "drivers/input/facts_file.hpp"

#include <cmath>

#include "drivers/config/toml_table.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "verification/observations/raft_fraction.hpp"

namespace traceraft::input {
namespace {

double in_range(const config::TomlTable& toml, const char* key, double low, double high) {
  const double value = toml.number(key);
  if (value >= low && value <= high) return value;
  throw InputError(toml.where(key) + ": " + format_number(value) + " is out of range (allowed: " +
                   format_number(low) + " to " + format_number(high) + ")");
}

int whole_number(const config::TomlTable& toml, const char* key, double low, double high) {
  const double value = in_range(toml, key, low, high);
  if (value == std::floor(value)) return static_cast<int>(value);
  throw InputError(toml.where(key) + ": " + format_number(value) + " is not a whole number");
}

}  // namespace

observations::PublishedFacts read_facts(const std::filesystem::path& path) {
  const config::TomlTable toml = config::TomlTable::read(
      path, {"name", "origin", "composition", "temperature", "vesicles", "measurements", "fraction",
             "fraction_sd", "radius_min", "radius_max", "perimeter_c", "perimeter_t0",
             "perimeter_b", "perimeter_scatter", "window_begin", "window_end", "outliers"});
  observations::PublishedFacts facts;
  facts.name = toml.text("name");
  facts.origin = toml.text("origin");
  facts.composition = toml.text("composition");
  (void)observations::membrane_mixture(toml.where("composition"), facts.composition);
  facts.celsius = in_range(toml, "temperature", -10, 100);
  facts.vesicles = whole_number(toml, "vesicles", 1, 1e6);
  facts.measurements = whole_number(toml, "measurements", facts.vesicles, 1e6);
  facts.fraction = in_range(toml, "fraction", 1e-3, 0.999);
  facts.fraction_sd = in_range(toml, "fraction_sd", 0, 1);
  facts.radius_min = in_range(toml, "radius_min", 0.05, 1000);
  facts.radius_max = in_range(toml, "radius_max", facts.radius_min, 1000);
  facts.window = {in_range(toml, "window_begin", 1e-6, 1e9), 0};
  facts.window.end = in_range(toml, "window_end", facts.window.begin, 1e9);
  facts.perimeter = {in_range(toml, "perimeter_c", 1e-6, 1e9),
                     in_range(toml, "perimeter_t0", -1e9, 0.999 * facts.window.begin),
                     in_range(toml, "perimeter_b", -10, 10),
                     in_range(toml, "perimeter_scatter", 0, 2)};
  facts.outliers =
      toml.has("outliers") ? whole_number(toml, "outliers", 0, facts.measurements) : -1;
  return facts;
}

}  // namespace traceraft::input
