// What options say of the integrator and the linear solver.
#pragma once

#include "backends/list.hpp"
#include "drivers/config/configuration.hpp"
#include "kernel/fem/surface_space.hpp"

namespace traceraft {

// Steps in R²/D. Throw InputError.
IntegratorSettings integrator_settings(const Configuration& configuration,
                                       const IntegratorEntry& integrator, const Units& units);
LinearSolverChoice linear_solver(const Configuration& configuration, const SurfaceSpace& space);

}  // namespace traceraft
