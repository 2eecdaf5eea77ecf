#include "kernel/effects/effects.hpp"

#include <algorithm>

#include "kernel/core/text.hpp"

namespace traceraft::effects {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

constexpr double kBoltzmann = 1.380649e-5;  // pN µm/K

bool needs_forces(const std::string& unit) {
  return unit == "pN" || unit == "nPa s m" || unit == "mPa s" || unit == "K";
}

// The parameters with defaults, which are in µm and s, in the units that values are given in.
std::vector<ParameterSpec> specs_in(const EffectEntry& entry, const physics::Units& units) {
  physics::Units physical = units;
  physical.scaled = false;
  std::vector<ParameterSpec> specs = entry.parameters;
  for (ParameterSpec& spec : specs)
    spec.default_value *= to_model_units(spec.unit, physical) / to_model_units(spec.unit, units);
  return specs;
}

void require_strength(const EffectEntry& entry, const Parameters& given) {
  const auto last = entry.parameters.begin() + entry.strengths;
  if (std::any_of(entry.parameters.begin(), last,
                  [&](const ParameterSpec& spec) { return given[spec.name] != 0; }))
    return;
  std::vector<std::string> strengths;
  for (auto spec = entry.parameters.begin(); spec != last; ++spec) strengths.push_back(spec->name);
  throw InputError("effect " + entry.name + ": a strength other than 0 is needed, as in " +
                   entry.name + ":" + joined(strengths, "=..., or ") + "=...");
}

// An effect says itself which of its strengths contradict each other.
void refuse_idle_parameters(const EffectEntry& entry, const EffectTerm& term,
                            const Parameters& given, const std::vector<ParameterSpec>& specs) {
  for (std::size_t k = static_cast<std::size_t>(entry.strengths); k < specs.size(); ++k)
    if (given[specs[k].name] != specs[k].default_value && !is_used(term, k))
      throw InputError("effect " + entry.name + ": " + specs[k].name +
                       " does nothing beside the other values; leave it out");
}

void refuse_forces(const EffectEntry& entry, const Parameters& given) {
  std::vector<std::string> numbers;
  for (int k = 0; k < entry.strengths; ++k)
    if (const ParameterSpec& spec = entry.parameters[static_cast<std::size_t>(k)];
        !needs_forces(spec.unit))
      numbers.push_back(spec.name);
  for (const ParameterSpec& spec : entry.parameters)
    if (needs_forces(spec.unit) && given[spec.name] != spec.default_value)
      throw InputError("effect " + entry.name + ": " + spec.name + " is in " + spec.unit +
                       ", and a scaled run has no such unit; give " + joined(numbers, " or "));
}

// Temperatures are absolute. Degrees Celsius by mistake would be far below any membrane's.
void refuse_celsius(const EffectEntry& entry, const Parameters& given) {
  constexpr double kColdest = 200, kZeroCelsius = 273.15;
  for (const ParameterSpec& spec : entry.parameters) {
    const double value = given[spec.name];
    if (spec.unit == "K" && value != 0 && value < kColdest)
      throw InputError("effect " + entry.name + ": " + spec.name + " = " + format_number(value) +
                       " K is out of range (allowed: 0 and " + format_number(kColdest) + " to " +
                       format_number(spec.max) + "); " + format_number(value) + " C are " +
                       format_number(value + kZeroCelsius) + " K");
  }
}

EffectTerm read_term(const std::string& one, const physics::Units& units) {
  const NamedArguments named = split_named_arguments(one);
  const EffectEntry& entry = effects().find(named.name);
  const std::vector<ParameterSpec> specs = specs_in(entry, units);
  const Parameters given = parse_parameters("effect " + entry.name, named.arguments, specs);
  require_strength(entry, given);
  if (units.scaled) refuse_forces(entry, given);
  refuse_celsius(entry, given);
  EffectTerm term{entry.name, {}};
  for (const ParameterSpec& spec : entry.parameters)
    term.values.push_back(given[spec.name] * to_model_units(spec.unit, units));
  refuse_idle_parameters(entry, term, given, specs);
  return term;
}

void add(const EffectTerm& term, problem::CahnHilliardModel& model) {
  const EffectEntry& entry = effects().find(term.effect);
  if (entry.unit_wells && !has_unit_wells(model))
    throw InputError("effect " + entry.name + ": it needs wells at 0 and 1, not at " +
                     format_number(model.well.a) + " and " + format_number(model.well.b));
  entry.add(Parameters(entry.parameters, term.values), model);
}

}  // namespace

bool is_used(const EffectTerm& term, std::size_t parameter) {
  const EffectEntry& entry = effects().find(term.effect);
  return !entry.uses ||
         entry.uses(Parameters(entry.parameters, term.values), entry.parameters[parameter].name);
}

const std::string& physics_of(const EffectTerm& term) {
  const EffectEntry& entry = effects().find(term.effect);
  return term.values.front() < 0 && !entry.reversed.empty() ? entry.reversed : entry.summary;
}

bool discs_can_have(const EffectTerm& term, const problem::CahnHilliardModel& model) {
  if (effects().find(term.effect).add_to_discs) return true;
  const problem::CahnHilliardModel alone = with_effects(model, {term});
  return alone.effects.size() == model.effects.size() && !alone.diffusion_ratio;
}

discs::DiscModel disc_model(const problem::CahnHilliardModel& model,
                            const std::vector<EffectTerm>& terms) {
  std::vector<EffectTerm> laws, others;  // laws first: others may ask for the line tension
  for (const EffectTerm& term : terms)
    (effects().find(term.effect).add_to_discs ? others : laws).push_back(term);
  for (const EffectTerm& law : laws)
    if (!discs_can_have(law, model))
      throw InputError("effect " + law.effect + ": the model of discs does not have it");
  const problem::CahnHilliardModel changed = with_effects(model, laws);
  discs::DiscModel result;
  result.mobility = changed.mobility;
  result.well = changed.well;
  result.epsilon = changed.epsilon;
  result.seed = changed.seed;
  for (const EffectTerm& term : others) {
    const EffectEntry& entry = effects().find(term.effect);
    entry.add_to_discs(Parameters(entry.parameters, term.values), result);
  }
  return result;
}

bool is_rate(const std::string& unit) {
  return unit == "1/s" || unit == "K/s";
}

double to_model_units(const std::string& unit, const physics::Units& units) {
  if (is_rate(unit)) return units.time();
  if (unit == "s") return 1 / units.time();
  if (unit == "um") return 1 / units.length();
  const double diffusion = units.diffusion_cm2_s * physics::Units::kUm2PerCm2;  // µm²/s
  if (unit == "mPa s") return 1e-3 * diffusion;                                 // pN s/µm²
  if (unit == "nPa s m") return 1e-3 * diffusion / units.radius_um;             // pN s/µm
  if (unit == "K") return kBoltzmann / units.radius_um;
  return 1;
}

const NamedList<EffectEntry>& effects() {
  static const NamedList<EffectEntry> list(
      "effect", {allen_cahn_effect(), asymmetry_effect(), bulk_mobility_effect(), cooling_effect(),
                 curvature_effect(), exchange_effect(), flow_effect(), gravity_effect(),
                 line_tension_effect(), mobility_contrast_effect(), mobility_exponent_effect(),
                 ohta_kawasaki_effect(), rotation_effect(), thermal_effect(), uptake_effect()});
  return list;
}

bool has_unit_wells(const problem::CahnHilliardModel& model) {
  return model.well.a == 0 && model.well.b == 1;
}

problem::CahnHilliardModel with_effects(problem::CahnHilliardModel model,
                                        const std::vector<EffectTerm>& terms) {
  std::vector<EffectTerm> ordered = terms;
  const auto stage = [](const EffectTerm& term) { return effects().find(term.effect).stage; };
  std::stable_sort(ordered.begin(), ordered.end(),
                   [&](const EffectTerm& a, const EffectTerm& b) { return stage(a) < stage(b); });
  for (const EffectTerm& term : ordered) add(term, model);
  return model;
}

std::vector<EffectTerm> read_effects(const std::string& specification,
                                     const physics::Units& units) {
  std::vector<EffectTerm> terms;
  for (std::size_t begin = 0; begin <= specification.size();) {
    const std::size_t end = std::min(specification.find(';', begin), specification.size());
    const std::string one = trimmed(specification.substr(begin, end - begin));
    begin = end + 1;
    if (one.empty()) continue;
    terms.push_back(read_term(one, units));
    for (std::size_t k = 0; k + 1 < terms.size(); ++k)
      if (terms[k].effect == terms.back().effect)
        throw InputError("effect " + terms[k].effect + ": it is given twice");
  }
  return terms;
}

std::vector<std::pair<std::string, std::string>> descriptions(
    const std::vector<EffectTerm>& terms, const problem::CahnHilliardModel& model,
    const physics::Units& units) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const EffectTerm& term : terms)
    if (const EffectEntry& entry = effects().find(term.effect); entry.description)
      result.emplace_back(
          term.effect, entry.description(Parameters(entry.parameters, term.values), model, units));
  return result;
}

void add_effects(const std::string& specification, const physics::Units& units,
                 problem::CahnHilliardModel& model) {
  model = with_effects(std::move(model), read_effects(specification, units));
}

}  // namespace traceraft::effects
