#include "drivers/config/options.hpp"

#include "backends/list.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft {

namespace {

// After the general options, those that only one integrator or linear solver has.
std::vector<OptionSpec> with_own_options(std::vector<OptionSpec> table) {
  for (const IntegratorEntry& integrator : integrators())
    for (const ParameterSpec& p : integrator.parameters) {
      const bool time = p.unit == "s";
      table.push_back({integrator_option(integrator, p),
                       p.integer ? OptionKind::integer : OptionKind::number,
                       format_number(p.default_value), "Integrator " + integrator.name,
                       p.meaning + (time ? " (s)" : ""), p.min, p.max,
                       time ? Dimension::time : Dimension::none});
    }
  for (const LinearSolverEntry& solver : linear_solvers())
    for (const WordOption& o : solver.options)
      table.push_back({linear_solver_option(solver, o),
                       o.file ? OptionKind::path : OptionKind::text, o.default_word,
                       "Linear solver " + solver.name, o.meaning});
  return table;
}

}  // namespace

std::string integrator_option(const IntegratorEntry& integrator, const ParameterSpec& parameter) {
  return integrator.name + "-" + parameter.name;
}

std::string linear_solver_option(const LinearSolverEntry& solver, const WordOption& option) {
  return solver.name + "-" + option.name;
}

const std::vector<OptionSpec>& run_options() {
  using K = OptionKind;
  using D = Dimension;
  static const std::vector<OptionSpec> table = with_own_options({
      {"case", K::text, "guv-2to1", "Case",
       "named set of defaults, which may differ from those below (see: traceraft list)"},
      {"scaled", K::flag, "false", "Case",
       "all inputs and outputs in units of R and R^2/D instead of um and s"},

      {"surface", K::text, "sphere", "Surface",
       "surface, with parameters as in torus:major=1,minor=0.4 (units of R), or formula"},
      {"surface-formula", K::text, "", "Surface",
       "level set phi(x,y,z), negative inside, for --surface formula (units of R)"},
      {"radius", K::number, "5", "Surface", "surface scale R in um (half a vesicle's diameter)",
       1e-6, 1e9},
      {"cells", K::integer, "128", "Surface", "cells per edge of the box [-5/3 R, 5/3 R]^3", 4,
       4096},

      {"epsilon", K::number, "0.05", "Physics", "width of the phase boundary (um)", 1e-9, 1e9,
       D::length},
      {"diffusion", K::number, "1e-5", "Physics", "mobility prefactor D in cm^2/s", 1e-30, 1e30},
      {"mobility", K::text, "degenerate", "Physics",
       "mobility law in units of D: degenerate, degenerate:outside=-1, constant:value=0.25"},
      {"well", K::text, "rho=0.25,a=0,b=1", "Physics",
       "free energy rho (c-a)^2 (b-c)^2 of a homogeneous mixture"},
      {"effect", K::text, "", "Physics",
       "what is added to the model, as in exchange:rate=1e-3,target=0.2; several between "
       "semicolons or by several flags (see: traceraft list)",
       0, 0, D::none, true, true},
      {"potential", K::text, "averaged", "Physics",
       "free energy of an element: from the mean of its square root (averaged: exact line "
       "tension), by quadrature (consistent), or nodal as in the paper's code"},
      {"stabilisation", K::number, "1", "Physics",
       "normal-gradient stabilisation, in units of the mesh size", 1e-6, 1e6},
      {"mass-stabilisation", K::number, "0.3", "Physics",
       "the same of the mass matrix, where it slows short waves; 1 as in the paper's code", 1e-3,
       1e3},

      {"initial", K::text, "noise", "Initial state",
       "noise, band-limited:wavelength=0.3,amplitude=0.05, caps, formula, or restart:DIR"},
      {"initial-formula", K::text, "", "Initial state",
       "c(x,y,z) for --initial formula (units of R)"},
      {"initial-caps", K::text, "", "Initial state",
       "rafts for --initial caps: \"x y z angle; ...\" with directions and half angles in degrees"},
      {"raft-fraction", K::number, "0.16", "Initial state",
       "mean of (c-a)/(b-a) for noise, met exactly", 0.0, 1.0},
      {"noise-cells", K::integer, "0", "Initial state",
       "cells per edge of the mesh on which noise is drawn, at most --cells; 0: a quarter of "
       "--cells",
       0, 4096},
      {"seed", K::integer, "1", "Initial state", "seed of the noise", 0, kLargestSeed},

      {"t-end", K::number, "25000", "Time", "end of the run (s)", 1e-300, 1e300, D::time},
      {"output-times", K::numbers, "", "Time",
       "times of fields and observables.csv (s), comma-separated; default: 0 and 16 times up to "
       "the end, evenly spaced in log t",
       0, 1e300, D::time},
      {"integrator", K::text, "ida", "Time", "time integrator (see: traceraft list)"},
      {"tolerance", K::number, "1e-3", "Time",
       "relative error per step in L2 of the surface; default of euler: 5e-3", 1e-12, 0.5},
      {"initial-step", K::number, "0", "Time", "first step (s); 0: from the initial state", 0,
       1e300, D::time},
      {"min-step", K::number, "0", "Time", "smallest step (s); 0: 1e-14 of the run", 0, 1e300,
       D::time},
      {"max-step", K::number, "0", "Time", "largest step (s); 0: unbounded", 0, 1e300, D::time},
      {"keep", K::text, "second", "Time",
       "which solution of the euler pair goes on: second (as in the paper), first, or decaying: "
       "second unless it gains energy"},

      {"energy-guard", K::text, "warn", "Time",
       "steps that gain energy where the model can only lose it: warn, reject, or off"},

      {"linear-solver", K::text, "block", "Linear algebra", "linear solver (see: traceraft list)"},
      {"linear-tolerance", K::number, "0", "Linear algebra",
       "relative residual of each correction; 0: the integrator's choice (euler 1e-4, ida 5e-2, "
       "rosenbrock up to 1e-3)",
       0, 0.5},
      {"threads", K::integer, "0", "Linear algebra",
       "threads; 0: all processors, at most 2. Results do not depend on it", 0, 64, D::none, false},

      {"checkpoint-interval", K::number, "30", "Output",
       "wall-clock seconds between checkpoints; 0: after every step", 0, 1e9, D::none, false},
      {"fields", K::flag, "true", "Output",
       "write fields for ParaView and pictures at the output times (on unless --no-fields)", 0, 0,
       D::none, false},
  });
  return table;
}

std::vector<std::string> run_option_names() {
  std::vector<std::string> names;
  for (const OptionSpec& spec : run_options()) names.push_back(spec.name);
  return names;
}

const OptionSpec& run_option(const std::string& name) {
  for (const OptionSpec& spec : run_options())
    if (spec.name == name) return spec;
  throw InputError(unknown_name_message("option", name, run_option_names()));
}

}  // namespace traceraft
