// The one list of the integrators and linear solvers that were built in.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/fem/surface_space.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft {

struct LinearSolverEntry {
  std::string name;
  std::string summary;
  std::string fallback;  // name of the solver to fall back on, or ""
  std::function<LinearSolverFactory(const SurfaceSpace&)> make;
};

struct IntegratorEntry {
  std::string name;
  std::string summary;
  double tolerance;  // unless asked for otherwise
  std::function<IntegratorPtr(const DaeProblem&, const LinearSolverChoice&,
                              std::shared_ptr<const ThreadTeam>, const IntegratorSettings&)>
      make;
  std::vector<ParameterSpec> parameters = {};  // its own options: --<name>-<parameter>
};

const NamedList<LinearSolverEntry>& linear_solvers();
const NamedList<IntegratorEntry>& integrators();

// The named solver together with its fallback. Throws InputError.
LinearSolverChoice choose_linear_solver(const std::string& name, const SurfaceSpace& space);

}  // namespace traceraft
