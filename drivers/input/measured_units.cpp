#include "drivers/input/measured_units.hpp"

#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft {
namespace {

struct Unit {
  std::string name;
  double factor;
};

double factor(const NamedList<Unit>& units, const TomlTable& toml, const std::string& key) {
  const std::string name = toml.text(key);
  try {
    return units.find(name).factor;
  } catch (const InputError& error) {
    throw InputError(toml.where(key) + ": " + error.what());
  }
}

}  // namespace

bool is_synthetic(const TomlTable& toml) {
  const std::string kind = toml.text("kind");
  if (kind != "measured" && kind != "synthetic")
    throw InputError(toml.where("kind") + ": '" + kind + "' is neither measured nor synthetic");
  return kind == "synthetic";
}

double length_factor(const TomlTable& toml, const std::string& key) {
  static const NamedList<Unit> units("unit of length", {{"um", 1},
                                                        // with the micro sign, and with a mu
                                                        {"\u00b5m", 1},
                                                        {"\u03bcm", 1},
                                                        {"nm", 1e-3},
                                                        {"mm", 1e3}});
  return factor(units, toml, key);
}

double time_factor(const TomlTable& toml, const std::string& key) {
  static const NamedList<Unit> units("unit of time",
                                     {{"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}});
  return factor(units, toml, key);
}

double time_offset(const TomlTable& toml) {
  const double offset = toml.number_or("time_offset", 0);
  if (!std::isfinite(offset))
    throw InputError(toml.where("time_offset") + ": a finite number is needed here");
  return offset;
}

void refuse_scaled(const Configuration& model) {
  if (model.flag("scaled"))
    throw InputError(model.where("scaled") + ": measurements are in seconds and micrometres");
}

}  // namespace traceraft
