#include "kernel/effects/effects.hpp"

namespace traceraft {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

void add_one(const std::string& text, const Units& units, CahnHilliardModel& model) {
  const NamedArguments named = split_named_arguments(text);
  const EffectEntry& entry = effects().find(named.name);
  const Parameters given =
      parse_parameters("effect " + named.name, named.arguments, entry.parameters);
  const ParameterSpec& strength = entry.parameters.front();
  if (given[strength.name] == strength.default_value)
    throw InputError("effect " + named.name + ": say how strong it is, as in " + named.name + ":" +
                     strength.name + "=...");
  std::vector<double> values;
  for (const ParameterSpec& spec : entry.parameters)
    values.push_back(given[spec.name] * to_model_units(spec.unit, units));
  entry.add(Parameters(entry.parameters, values), model);
}

}  // namespace

double to_model_units(const std::string& unit, const Units& units) {
  if (unit == "1/s") return units.time();
  if (unit == "s") return 1 / units.time();
  if (unit == "um") return 1 / units.length();
  return 1;
}

const NamedList<EffectEntry>& effects() {
  static const NamedList<EffectEntry> list(
      "effect", {allen_cahn_effect(), asymmetry_effect(), bulk_mobility_effect(), cooling_effect(),
                 curvature_effect(), exchange_effect(), gravity_effect(), line_tension_effect(),
                 mobility_contrast_effect(), mobility_exponent_effect(), ohta_kawasaki_effect(),
                 rotation_effect(), thermal_effect(), uptake_effect()});
  return list;
}

void add_effects(const std::string& specification, const Units& units, CahnHilliardModel& model) {
  for (std::size_t begin = 0; begin <= specification.size();) {
    const std::size_t end = std::min(specification.find(';', begin), specification.size());
    const std::string one = trimmed(specification.substr(begin, end - begin));
    if (!one.empty()) add_one(one, units, model);
    begin = end + 1;
  }
}

}  // namespace traceraft
