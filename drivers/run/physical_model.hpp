// What options say of the physics: free energy, mobility, effects, and the surface it happens on.
#pragma once

#include "drivers/config/configuration.hpp"
#include "kernel/geometry/level_set.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft {

// In units of R and R²/D. Throw InputError.
DoubleWell double_well(const Configuration& configuration);
LevelSetPtr surface_of(const Configuration& configuration);
CahnHilliardModel physical_model(const Configuration& configuration);

}  // namespace traceraft
