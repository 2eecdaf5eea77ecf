#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/brownian_flow.hpp"
#include "kernel/effects/capillary_flow.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::effects {
namespace {

// The three numbers are given, or follow from viscosities, line tension and temperature. Forces are
// in pN here, lengths in R and times in R²/D.
flow::FluidMembrane membrane_of(const Parameters& p, double epsilon,
                                const physics::DoubleWell& well) {
  const double viscosity = p["membrane-viscosity"];
  if (viscosity == 0) {
    if (p["line-tension"] != 0 || p["temperature"] != 0)
      throw InputError("effect flow: line-tension and temperature need membrane-viscosity");
    return {p["capillary"], p["water"], p["thermal"]};
  }
  if (p["capillary"] != 0 || p["thermal"] != 0)
    throw InputError(
        "effect flow: give membrane-viscosity, with line-tension and temperature, or capillary and "
        "thermal");
  const flow::FluidMembrane membrane{
      flow::capillary_number(p["line-tension"], epsilon, well.interface_energy(), viscosity),
      p["water-viscosity"] / viscosity, p["temperature"] / viscosity};
  if (membrane.capillary == 0 && membrane.thermal == 0)
    throw InputError(
        "effect flow: membrane-viscosity alone moves nothing; add line-tension, temperature or "
        "both");
  return membrane;
}

double hold_of(const Parameters& p, const flow::FluidMembrane& membrane, double epsilon) {
  return p["hold"] > 0 ? p["hold"] : flow::hold_of(membrane, epsilon);
}

std::uint64_t seed_of(const Parameters& p, std::uint64_t run_seed) {
  return (static_cast<std::uint64_t>(p["seed"]) << 32) + run_seed;
}

// Numbers, or viscosities and forces; and of Brownian motion only where there is some.
bool flow_uses(const Parameters& p, const std::string& name) {
  const bool physical = p["membrane-viscosity"] != 0,
             brownian = p["thermal"] != 0 || p["temperature"] != 0;
  if (name == "hold") return brownian && p["hold"] != 0;
  if (name == "seed") return brownian;
  if (name == "capillary") return !physical && (p["capillary"] != 0 || !brownian);
  if (name == "thermal") return !physical && brownian;
  if (name == "water") return !physical;
  if (name == "line-tension" || name == "temperature") return p[name] != 0;
  return physical;
}

std::string flow_description(const Parameters& p, const problem::CahnHilliardModel& model,
                             const physics::Units& units) {
  const flow::FluidMembrane membrane = membrane_of(p, model.epsilon, model.well);
  return formatted(
      "capillary A = %.4g, thermal Theta = %.4g, water W = %.4g; Saffman-Delbrueck length %.4g %s",
      membrane.capillary, membrane.thermal, membrane.water, 0.5 / membrane.water * units.length(),
      units.scaled ? "R" : "um");
}

void add_flow(const Parameters& p, problem::CahnHilliardModel& model) {
  const flow::FluidMembrane membrane = membrane_of(p, model.epsilon, model.well);
  if (membrane.capillary > 0)
    model.effects.push_back(std::make_shared<CapillaryFlow>(membrane, model.epsilon));
  if (membrane.thermal > 0)
    model.effects.push_back(std::make_shared<BrownianFlow>(
        membrane, model.epsilon, hold_of(p, membrane, model.epsilon), seed_of(p, model.seed)));
}

void add_flow_to_discs(const Parameters& p, discs::DiscModel& model) {
  model.membrane = membrane_of(p, model.epsilon, model.well);
  if (model.membrane.thermal == 0)
    throw InputError(
        "effect flow: only Brownian motion moves discs; give membrane-viscosity with temperature, "
        "or thermal");
  if (p["hold"] > 0) throw InputError("effect flow: discs need no hold; leave it out");
  model.seed = seed_of(p, model.seed);
}

}  // namespace

std::vector<EffectTerm> in_single_strengths(const EffectTerm& term, double epsilon,
                                            const physics::DoubleWell& well) {
  if (term.effect != "flow") return {term};
  const std::vector<ParameterSpec>& specs = effects().find(term.effect).parameters;
  const flow::FluidMembrane membrane = membrane_of(Parameters(specs, term.values), epsilon, well);
  const auto with = [&](const std::string& strength, double value) {
    EffectTerm single = term;
    for (std::size_t k = 0; k < specs.size(); ++k) {
      const std::string& name = specs[k].name;
      if (name == strength)
        single.values[k] = value;
      else if (name == "water")
        single.values[k] = membrane.water;
      else if (name != "hold" && name != "seed")
        single.values[k] = specs[k].default_value;
    }
    return single;
  };
  std::vector<EffectTerm> singles;
  if (membrane.capillary > 0) singles.push_back(with("capillary", membrane.capillary));
  if (membrane.thermal > 0) singles.push_back(with("thermal", membrane.thermal));
  return singles;
}

EffectEntry flow_effect() {
  EffectEntry entry{
      "flow",
      "flow of the membrane, which the line tension of rafts and thermal forces drive",
      "",
      {{"capillary", "", 0, 0, 1e12, "A = e R^2/(eta_m D), with the unit e of energy density"},
       {"thermal", "", 0, 0, 1e6, "Theta = k_B T/(eta_m D), the strength of Brownian motion"},
       {"membrane-viscosity", "nPa s m", 0, 0, 1e6, "eta_m; gives A, W and Theta with the next"},
       {"line-tension", "pN", 0, 0, 1e3, "of a boundary; 0: it does not move the membrane"},
       {"temperature", "K", 0, 0, 500, "of Brownian motion; 0: there is none"},
       {"water-viscosity", "mPa s", 1, 1e-3, 1e3, "eta_w, on both sides"},
       {"water", "", 1.25, 1e-3, 1e3, "W = R eta_w/eta_m, the drag of the water"},
       {"hold", "s", 0, 0, 1e9, "time between draws; 0: a small raft moves half of epsilon in it"},
       {"seed", "", 1, 0, 1e9, "seed of the draws, combined with that of the run",
        ParameterKind::integer}},
      MassClass::conserves,
      EnergyClass::dissipates,
      "rafts that become round and merge faster",
      {"mobility-contrast"},
      add_flow};
  entry.strengths = 3;
  entry.stage = EffectEntry::kFirst;
  entry.description = flow_description;
  entry.add_to_discs = add_flow_to_discs;
  entry.uses = flow_uses;
  return entry;
}

}  // namespace traceraft::effects
