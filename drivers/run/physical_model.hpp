// The physics as options say it: free energy, mobility, effects, and the surface it happens on.
#pragma once

#include "drivers/config/configuration.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/geometry/level_set.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::run {

// In units of R and R²/D. Throw InputError.
physics::DoubleWell double_well(const config::Configuration& configuration);
geometry::LevelSetPtr surface_of(const config::Configuration& configuration);
problem::CahnHilliardModel model_without_effects(const config::Configuration& configuration);
std::vector<effects::EffectTerm> effects_of(const config::Configuration& configuration);
// Both together.
problem::CahnHilliardModel physical_model(const config::Configuration& configuration);

}  // namespace traceraft::run
