#include "kernel/effects/effects.hpp"

#include <algorithm>

namespace traceraft {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

struct ChosenEffect {
  const EffectEntry* entry;
  std::string arguments;
};

std::vector<ChosenEffect> chosen_effects(const std::string& specification) {
  std::vector<ChosenEffect> chosen;
  for (std::size_t begin = 0; begin <= specification.size();) {
    const std::size_t end = std::min(specification.find(';', begin), specification.size());
    const std::string one = trimmed(specification.substr(begin, end - begin));
    begin = end + 1;
    if (one.empty()) continue;
    const NamedArguments named = split_named_arguments(one);
    chosen.push_back({&effects().find(named.name), named.arguments});
  }
  return chosen;
}

void add_one(const ChosenEffect& chosen, const Units& units, CahnHilliardModel& model) {
  const EffectEntry& entry = *chosen.entry;
  const Parameters given =
      parse_parameters("effect " + entry.name, chosen.arguments, entry.parameters);
  const ParameterSpec& strength = entry.parameters.front();
  if (given[strength.name] == strength.default_value)
    throw InputError("effect " + entry.name + ": say how strong it is, as in " + entry.name + ":" +
                     strength.name + "=...");
  if (entry.unit_wells && (model.well.a != 0 || model.well.b != 1))
    throw InputError("effect " + entry.name + ": it is made for wells at 0 and 1, not at " +
                     format_number(model.well.a) + " and " + format_number(model.well.b));
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
  std::vector<ChosenEffect> chosen = chosen_effects(specification);
  std::stable_partition(chosen.begin(), chosen.end(),
                        [](const ChosenEffect& one) { return one.entry->changes_mobility; });
  for (const ChosenEffect& one : chosen) add_one(one, units, model);
}

}  // namespace traceraft
