// The viscosity of a membrane whose rafts are seen to meet.
#pragma once

#include "kernel/effects/effects.hpp"
#include "kernel/flow/fluid_membrane.hpp"

namespace traceraft::selection {

// W of a membrane with this viscosity (nPa s m) between waters of the default viscosity.
double drag_of_water(double viscosity, const physics::Units& units);

// Θ of a membrane with this viscosity at this temperature.
double thermal_of(double viscosity, double kelvin, const physics::Units& units);

// The viscosity (nPa s m) of a membrane whose rafts meet as fast as those with these two numbers.
// Its own drag is not `water`, which changes what rafts far from each other do by another factor
// than what near ones do. The factor is that of two rafts of 0.3 R at a distance of 0.5 R. It is
// right within 10 % for others if the viscosity is off by a factor of two.
double viscosity_of(double thermal, double water, double kelvin, const physics::Units& units);

// The effect flow of a membrane that is described by its numbers.
effects::EffectTerm flow_with(const flow::FluidMembrane& membrane, const physics::Units& units);
// The numbers of such an effect.
flow::FluidMembrane membrane_of(const effects::EffectTerm& flow);
// The effect flow by the viscosity (nPa s m), with Brownian motion alone.
effects::EffectTerm brownian_flow(double viscosity, double kelvin, const physics::Units& units);

}  // namespace traceraft::selection
