// The integrator and the linear solver, as options say them.
#pragma once

#include "backends/list.hpp"
#include "drivers/config/configuration.hpp"
#include "kernel/fem/surface_space.hpp"

namespace traceraft::run {

// Steps in R²/D. Throw InputError.
time::IntegratorSettings integrator_settings(const config::Configuration& configuration,
                                             const backends::IntegratorEntry& integrator,
                                             const physics::Units& units);
linear::LinearSolverChoice linear_solver(const config::Configuration& configuration,
                                         const fem::SurfaceSpace& space);

}  // namespace traceraft::run
