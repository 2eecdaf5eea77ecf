// More flux, or less of it, than the mobility law of the model gives.
#pragma once

#include <functional>

#include "kernel/physics/mobility.hpp"
#include "kernel/problem/effect.hpp"

namespace traceraft::effects {

// Adds factor(t) K_law(c) μ to F1. The sum with the model's own flux has to stay one of a mobility
// that is not negative, if `dissipates`.
problem::EffectPtr mobility_flux(std::string name, physics::MobilityPtr law,
                                 std::function<double(double)> factor, bool dissipates);

}  // namespace traceraft::effects
