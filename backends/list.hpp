// The one list of the integrators and linear solvers that were built in.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/fem/surface_space.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::backends {

// Options of a linear solver that are given, by name.
using WordOptions = std::map<std::string, std::string>;

struct LinearSolverEntry {
  std::string name;
  std::string summary;
  std::string fallback;  // name of the solver to fall back on, or ""
  // Throws InputError for a space that it cannot serve and OptionError for options.
  std::function<linear::LinearSolverFactory(const fem::SurfaceSpace&, const WordOptions&)> make;
  std::vector<ParameterSpec> parameters = {};  // words and files: --<name>-<parameter>
  bool built = true;                           // if not, `make` says how to get it
  bool distributed = false;                    // does it work on several ranks?
};

struct IntegratorEntry {
  std::string name;
  std::string summary;
  double tolerance;  // unless asked for otherwise
  std::function<time::IntegratorPtr(const problem::DaeProblem&, const linear::LinearSolverChoice&,
                                    std::shared_ptr<const ThreadTeam>,
                                    const time::IntegratorSettings&)>
      make;
  std::vector<ParameterSpec> parameters = {};  // its own options: --<name>-<parameter>
};

const NamedList<LinearSolverEntry>& linear_solvers();
std::vector<std::string> built_linear_solvers();
const NamedList<IntegratorEntry>& integrators();

// The named solver together with its fallback. Throws InputError, OptionError.
linear::LinearSolverChoice choose_linear_solver(const std::string& name,
                                                const fem::SurfaceSpace& space,
                                                const WordOptions& options = {});

}  // namespace traceraft::backends
