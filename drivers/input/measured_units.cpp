#include "drivers/input/measured_units.hpp"

#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "verification/observations/raft_fraction.hpp"

namespace traceraft::input {
namespace {

struct FileUnit {
  std::string name;
  double factor;
};

double factor(const NamedList<FileUnit>& units, const config::TomlTable& toml,
              const std::string& key) {
  const std::string name = toml.text(key);
  try {
    return units.find(name).factor;
  } catch (const InputError& error) {
    throw InputError(toml.where(key) + ": " + error.what());
  }
}

}  // namespace

bool is_synthetic(const config::TomlTable& toml) {
  const std::string kind = toml.text("kind");
  if (kind != "measured" && kind != "synthetic")
    throw InputError(toml.where("kind") + ": '" + kind + "' is neither measured nor synthetic");
  return kind == "synthetic";
}

double length_factor(const config::TomlTable& toml, const std::string& key) {
  static const NamedList<FileUnit> units("unit of length", {{"um", 1},
                                                            // first the micro sign, then a mu
                                                            {"\u00b5m", 1},
                                                            {"\u03bcm", 1},
                                                            {"nm", 1e-3},
                                                            {"mm", 1e3}});
  return factor(units, toml, key);
}

double time_factor(const config::TomlTable& toml, const std::string& key) {
  static const NamedList<FileUnit> units("unit of time",
                                         {{"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}});
  return factor(units, toml, key);
}

double time_offset(const config::TomlTable& toml) {
  const double offset = toml.number_or("time_offset", 0);
  if (!std::isfinite(offset))
    throw InputError(toml.where("time_offset") + ": a finite number is needed here");
  return offset;
}

std::string composition_of(const config::TomlTable& toml) {
  const std::string composition = toml.text_or("composition", "");
  if (!composition.empty())
    (void)observations::membrane_mixture(toml.where("composition"), composition);
  return composition;
}

std::optional<double> celsius_of(const config::TomlTable& toml) {
  constexpr double kColdest = -20, kHottest = 100;
  if (!toml.has("temperature")) return std::nullopt;
  const double celsius = toml.number("temperature");
  if (celsius >= kColdest && celsius <= kHottest) return celsius;
  throw InputError(toml.where("temperature") + ": " + format_number(celsius) +
                   " degrees Celsius is impossible here (allowed: " + format_number(kColdest) +
                   " to " + format_number(kHottest) + ")");
}

double checked_time(double time, const std::string& where) {
  constexpr double kLatest = 1e9;
  if (!(time >= 0)) throw InputError(where + ": a time before time zero is impossible");
  if (time <= kLatest) return time;
  throw InputError(where + ": " + format_number(time) + " s is impossible (allowed: to " +
                   format_number(kLatest) + " s); is time_unit right?");
}

double checked_radius(double radius, const std::string& where) {
  // Vesicles that a light microscope shows; what is outside is in other units than it says.
  constexpr double kSmallestRadius = 0.05, kLargestRadius = 1000;
  if (radius >= kSmallestRadius && radius <= kLargestRadius) return radius;
  throw InputError(where + ": a vesicle of radius " + format_number(radius) +
                   " um is impossible here (allowed: " + format_number(kSmallestRadius) + " to " +
                   format_number(kLargestRadius) + "); is length_unit right?");
}

void refuse_scaled(const config::Configuration& model) {
  if (model.options().scaled)
    throw InputError(model.where(&config::RunOptions::scaled) +
                     ": measurements are in seconds and micrometres");
}

}  // namespace traceraft::input
