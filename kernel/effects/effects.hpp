// The effects that a model may be missing, by name. One file per effect, one line in effects.cpp;
// docs/effects.md shows how to add one.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/discs/disc_model.hpp"
#include "kernel/physics/units.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::effects {

enum class MassClass { conserves, drifts };
enum class EnergyClass { dissipates, neutral, active };

struct EffectEntry {
  std::string name;
  std::string summary;   // the physics
  std::string reversed;  // and with a negative strength; "" if it has none
  // The strength first, whose default, 0, is the base model. Units: "" for a pure number, "1/s",
  // "s", "um"; "pN", "nPa s m", "mPa s" and "K", which scaled runs do not have.
  std::vector<ParameterSpec> parameters;
  MassClass mass;
  EnergyClass energy;                      // with the first strength alone
  std::string shows_in;                    // what moves first
  std::vector<std::string> confused_with;  // names of effects
  // Adds it to a model. Parameters are in units of R and R²/D.
  std::function<void(const Parameters&, problem::CahnHilliardModel&)> add;
  bool unit_wells = false;  // it takes the phases to be at c = 0 and 1
  // Effects are added in this order, whatever order they are given in. Those that take the line
  // tension of the base model come first; those that change the mobility, in space or in time, come
  // before those that make something of it, the last.
  int stage = kLast;
  static constexpr int kFirst = 0, kLast = 100;
  int strengths = 1;  // the first parameters, of which one is needed
  // Says to people what follows from the parameters (in units of R and R²/D); may be empty.
  std::function<std::string(const Parameters&, const problem::CahnHilliardModel&,
                            const physics::Units&)>
      description = {};
  // Adds it to a vesicle of discs. Those that change the mobility or the line tension alone need
  // none; others without one are refused there.
  std::function<void(const Parameters&, discs::DiscModel&)> add_to_discs = {};
  // Does a parameter count, beside the values of the others? Empty: all do.
  std::function<bool(const Parameters&, const std::string& name)> uses = {};
};

EffectEntry allen_cahn_effect();
EffectEntry asymmetry_effect();
EffectEntry bulk_mobility_effect();
EffectEntry cooling_effect();
EffectEntry curvature_effect();
EffectEntry exchange_effect();
EffectEntry flow_effect();
EffectEntry gravity_effect();
EffectEntry line_tension_effect();
EffectEntry mobility_contrast_effect();
EffectEntry mobility_exponent_effect();
EffectEntry ohta_kawasaki_effect();
EffectEntry rotation_effect();
EffectEntry thermal_effect();
EffectEntry uptake_effect();

const NamedList<EffectEntry>& effects();

// An effect with values for all its parameters, in the order of its entry and in units of R and
// R²/D.
struct EffectTerm {
  std::string effect;
  std::vector<double> values;
};

// A flow as one term for each of the two that drive it, line tension and thermal forces, with their
// strengths A and Θ; any other effect as it is. Throws InputError for a flow that nothing drives.
std::vector<EffectTerm> in_single_strengths(const EffectTerm& term, double epsilon,
                                            const physics::DoubleWell& well);

// Does a parameter count, beside the values of the others?
bool is_used(const EffectTerm& term, std::size_t parameter);

// Its physics in words, by the sign of its strength.
const std::string& physics_of(const EffectTerm& term);

bool has_unit_wells(const problem::CahnHilliardModel& model);

// In any order, the same. Throws InputError for an unknown name, and for wells that an effect is
// not made for; ranges are those of whoever asks.
problem::CahnHilliardModel with_effects(problem::CahnHilliardModel model,
                                        const std::vector<EffectTerm>& terms);

// Does the model of discs have this effect?
bool discs_can_have(const EffectTerm& term, const problem::CahnHilliardModel& model);
// A vesicle of discs with the mobility, the wells and the line tension of `model`, and these
// effects. Throws InputError for an effect that discs do not have.
discs::DiscModel disc_model(const problem::CahnHilliardModel& model,
                            const std::vector<EffectTerm>& terms);

// A parameter per time?
bool is_rate(const std::string& unit);
// The factor from a parameter's unit to R and R²/D. Forces are in pN: a viscosity of a membrane in
// pN R²/D/R, one of water in pN R²/D/R², and a temperature stands for k_B T in pN R.
double to_model_units(const std::string& unit, const physics::Units& units);

// "exchange:rate=1e-3,target=0.2; gravity:strength=0.1", with parameters in their own units. Throws
// InputError for an unknown name or key, a value out of range, a strength that is not given, and an
// effect that is given twice.
std::vector<EffectTerm> read_effects(const std::string& specification, const physics::Units& units);
// The descriptions of those terms that have one: (name, text).
std::vector<std::pair<std::string, std::string>> descriptions(
    const std::vector<EffectTerm>& terms, const problem::CahnHilliardModel& model,
    const physics::Units& units);
// Added to the model, as by with_effects.
void add_effects(const std::string& specification, const physics::Units& units,
                 problem::CahnHilliardModel& model);

}  // namespace traceraft::effects
