// What options say of the integrator and the linear solver.
#pragma once

#include "backends/list.hpp"
#include "drivers/config/configuration.hpp"
#include "kernel/fem/surface_space.hpp"

namespace traceraft {

// Whose own options count.
struct NumericalMethods {
  std::vector<std::string> integrators, linear_solvers;
};
NumericalMethods methods_of_run(const Configuration& configuration);

// An option of another method is a mistake, not something to ignore; a configuration file may hold
// it. Throws InputError.
void refuse_options_of_others(const Configuration& configuration, const NumericalMethods& methods);

// Steps in R²/D. Throw InputError.
IntegratorSettings integrator_settings(const Configuration& configuration,
                                       const IntegratorEntry& integrator, const Units& units);
LinearSolverChoice linear_solver(const Configuration& configuration, const SurfaceSpace& space);

}  // namespace traceraft
