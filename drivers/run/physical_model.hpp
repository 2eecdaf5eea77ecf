// What options say of the physics: free energy, mobility, effects, and the surface it happens on.
#pragma once

#include "drivers/config/configuration.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/geometry/level_set.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft {

// In units of R and R²/D. Throw InputError.
DoubleWell double_well(const Configuration& configuration);
LevelSetPtr surface_of(const Configuration& configuration);
CahnHilliardModel model_without_effects(const Configuration& configuration);
std::vector<EffectTerm> effects_of(const Configuration& configuration);
// Both together.
CahnHilliardModel physical_model(const Configuration& configuration);

}  // namespace traceraft
