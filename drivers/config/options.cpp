#include "drivers/config/options.hpp"

#include <iterator>
#include <stdexcept>

#include "backends/list.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/fem/refinement_rule.hpp"

namespace traceraft::config {

namespace {

OptionKind kind_of(const OptionMember& member) {
  constexpr OptionKind kinds[] = {OptionKind::text,    OptionKind::text, OptionKind::number,
                                  OptionKind::integer, OptionKind::flag, OptionKind::numbers};
  static_assert(std::size(kinds) == std::variant_size_v<OptionMember>);
  return kinds[member.index()];
}

OptionKind kind_of(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::number:
      return OptionKind::number;
    case ParameterKind::integer:
      return OptionKind::integer;
    case ParameterKind::file:
      return OptionKind::path;
    default:
      return OptionKind::text;
  }
}

// `group`: "Integrator ida".
OptionSpec spec_of(const std::string& method, const std::string& group, const ParameterSpec& p) {
  OptionSpec spec;
  spec.name = method_option(method, p);
  spec.kind = kind_of(p.kind);
  spec.default_text = p.is_number() ? format_number(p.default_value) : p.default_text;
  spec.group = group;
  const bool time = p.unit == "s";
  spec.help = p.meaning + (time ? " (s)" : "");
  spec.min = p.min;
  spec.max = p.max;
  spec.dimension = time ? Dimension::time : Dimension::none;
  return spec;
}

// A name of a list (drivers/manual/value_lists.hpp), such as CASE.
OptionSpec listed(const char* list, OptionSpec spec) {
  spec.placeholder = list;
  return spec;
}

OptionSpec one_of(std::vector<std::string> words, OptionSpec spec) {
  spec.placeholder = joined(words, "|");
  spec.words = std::move(words);
  return spec;
}

std::string placeholder_of(OptionKind kind) {
  switch (kind) {
    case OptionKind::flag:
      return "";
    case OptionKind::path:
      return "FILE";
    case OptionKind::number:
    case OptionKind::integer:
      return "NUMBER";
    case OptionKind::numbers:
      return "NUMBER,...";
    default:
      return "TEXT";
  }
}

// After the general options, those that only one integrator or linear solver has.
std::vector<OptionSpec> with_own_options(std::vector<OptionSpec> table) {
  for (OptionSpec& spec : table) spec.kind = kind_of(spec.member);
  for (const backends::IntegratorEntry& method : backends::integrators())
    for (const ParameterSpec& p : method.parameters)
      table.push_back(spec_of(method.name, "Integrator " + method.name, p));
  for (const backends::LinearSolverEntry& method : backends::linear_solvers())
    for (const ParameterSpec& p : method.parameters)
      table.push_back(spec_of(method.name, "Linear solver " + method.name, p));
  for (OptionSpec& spec : table)
    if (spec.placeholder.empty()) spec.placeholder = placeholder_of(spec.kind);
  return table;
}

}  // namespace

std::string method_option(const std::string& method, const ParameterSpec& parameter) {
  return method + "-" + parameter.name;
}

const std::vector<OptionSpec>& run_options() {
  using R = RunOptions;
  using D = Dimension;
  static const std::vector<OptionSpec> table = with_own_options({
      listed(
          "CASE",
          {"case", &R::case_name, "guv-2to1", "Case",
           "named set of settings (see: traceraft list); the help shows the values of guv-2to1"}),
      {"scaled", &R::scaled, "false", "Case",
       "use R and R^2/D as units of all inputs and outputs, instead of um and s"},

      one_of({"field", "discs"},
             {"model", &R::model, "field", "Case",
              "field: the concentration on the whole surface; discs: rafts as discs of the same "
              "physics, much faster"}),

      listed("SURFACE",
             {"surface", &R::surface, "sphere", "Surface",
              "surface, with parameters in units of R as in torus:major=1,minor=0.4, or formula"}),
      {"surface-formula", &R::surface_formula, "", "Surface",
       "level set phi(x,y,z) for --surface formula, negative inside; coordinates in units of R"},
      {"radius", &R::radius, "5", "Surface",
       "length scale R of the surface (um): the radius of a spherical vesicle", 1e-6, 1e9},
      {"cells", &R::cells, "128", "Surface", "cells per edge of the box [-5/3 R, 5/3 R]^3", 4,
       4096},
      {"cells-per-boundary", &R::cells_per_boundary, "0", "Surface",
       "cells across a phase boundary, 6 epsilon, instead of --cells; 0: as --cells says", 0, 100},
      one_of({"uniform", "adaptive"},
             {"mesh", &R::mesh, "uniform", "Surface",
              "uniform: all cells of one size; adaptive: larger ones away from the phase "
              "boundaries, --cells being the smallest"}),
      {"mesh-levels", &R::mesh_levels, "0", "Surface",
       "how often the cells of --mesh adaptive double; 0: as often as the area keeps to 1e-5", 0,
       8},
      {"mesh-threshold", &R::mesh_threshold, format_number(fem::kBoundaryThreshold), "Surface",
       "epsilon |grad c| above which the cells of --mesh adaptive are the smallest; 0.18 is the "
       "largest in a boundary at rest",
       1e-4, 0.17},

      {"epsilon", &R::epsilon, "0.05", "Physics",
       "width parameter epsilon of the phase boundary (um)", 1e-9, 1e9, D::length},
      {"diffusion", &R::diffusion, "1e-5", "Physics", "mobility prefactor D (cm^2/s)", 1e-30, 1e30},
      listed(
          "MOBILITY",
          {"mobility", &R::mobility, "degenerate", "Physics",
           "mobility law in units of D: degenerate, degenerate:outside=-1, constant:value=0.25"}),
      {"well", &R::well, "rho=0.25,a=0,b=1", "Physics",
       "parameters of the free energy rho (c-a)^2 (b-c)^2 of a homogeneous mixture"},
      listed("EFFECT",
             {"effect", &R::effect, "", "Physics",
              "effect added to the model, as in exchange:rate=1e-3,target=0.2; separate several by "
              "semicolons, or repeat the flag (see: traceraft list)",
              0, 0, D::none, true, true}),
      one_of({"averaged", "consistent", "nodal"},
             {"potential", &R::potential, "averaged", "Physics",
              "free energy of an element: averaged (from the mean of its square root: exact line "
              "tension), consistent (by quadrature) or nodal (as in the paper's code)"}),
      {"stabilisation", &R::stabilisation, "1", "Physics",
       "coefficient of the normal-gradient stabilisation, in units of the mesh size", 1e-6, 1e6},
      {"mass-stabilisation", &R::mass_stabilisation, "0.3", "Physics",
       "the same in the mass matrix, where it slows short waves; 1 in the paper's code", 1e-3, 1e3},

      listed(
          "INITIAL",
          {"initial", &R::initial, "noise", "Initial state",
           "noise, band-limited:wavelength=0.3,amplitude=0.05, caps, discs:number=40, formula or "
           "restart:DIR; default with --model discs: discs"}),
      {"initial-formula", &R::initial_formula, "", "Initial state",
       "c(x,y,z) for --initial formula; coordinates in units of R"},
      {"initial-caps", &R::initial_caps, "", "Initial state",
       "rafts for --initial caps: \"x y z angle; ...\", each with direction and half angle "
       "(degrees)"},
      {"raft-fraction", &R::raft_fraction, "0.16", "Initial state",
       "mean of (c-a)/(b-a) for noise and discs; with noise the initial state has exactly this "
       "mean",
       0.0, 1.0},
      {"noise-cells", &R::noise_cells, "0", "Initial state",
       "cells per edge of the mesh of the noise, at most --cells; 0: a quarter of --cells", 0,
       4096},
      {"seed", &R::seed, "1", "Initial state",
       "seed of the initial state, and of effects that draw", 0, kLargestSeed},

      {"t-end", &R::t_end, "25000", "Time", "end of the run (s)", 1e-300, 1e300, D::time},
      {"output-times", &R::output_times, "", "Time",
       "output times of fields and observables.csv (s), comma-separated; default: 0 and 16 times "
       "up to the end, evenly spaced in log t",
       0, 1e300, D::time},
      listed("INTEGRATOR", {"integrator", &R::integrator, "ida", "Time",
                            "time integrator (see: traceraft list)"}),
      {"tolerance", &R::tolerance, "1e-3", "Time",
       "relative error of a step, in the L2 norm on the surface; default with euler: 5e-3, "
       "with --model discs, of the area of each: 5e-3",
       1e-12, 0.5},
      {"initial-step", &R::initial_step, "0", "Time",
       "first step (s); 0: chosen from the initial state", 0, 1e300, D::time},
      {"min-step", &R::min_step, "0", "Time",
       "smallest step (s); 0: 1e-14 of the length of the run", 0, 1e300, D::time},
      {"max-step", &R::max_step, "0", "Time", "largest step (s); 0: unbounded", 0, 1e300, D::time},
      one_of(
          {"second", "first", "decaying"},
          {"keep", &R::keep, "second", "Time",
           "solution of the euler pair that starts the next step: second order (second, as in the "
           "paper), first order (first), or second order unless the energy grows (decaying)"}),

      one_of({"warn", "reject", "off"}, {"energy-guard", &R::energy_guard, "warn", "Time",
                                         "treatment of steps that gain energy although the model "
                                         "can only lose it: warn, reject or "
                                         "off"}),

      listed("SOLVER", {"linear-solver", &R::linear_solver, "block", "Linear algebra",
                        "linear solver (see: traceraft list)"}),
      {"linear-tolerance", &R::linear_tolerance, "0", "Linear algebra",
       "tolerated relative residual of each linear solve; 0: the integrator's choice (euler 1e-4, "
       "ida 5e-2, rosenbrock up to 1e-3)",
       0, 0.5},
      {"threads", &R::threads, "0", "Linear algebra",
       "number of threads; 0: all processors, at most 2; results do not depend on it", 0, 64,
       D::none, false},

      {"checkpoint-interval", &R::checkpoint_interval, "30", "Output",
       "wall-clock time between checkpoints (s); 0: one after every step", 0, 1e9, D::none, false},
      {"fields", &R::fields, "true", "Output",
       "write fields for ParaView and pictures at the output times; --no-fields turns this off", 0,
       0, D::none, false},
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

const OptionSpec& run_option(const OptionMember& member) {
  for (const OptionSpec& spec : run_options())
    if (spec.member == member) return spec;
  throw std::logic_error("an option that is not in the list");
}

}  // namespace traceraft::config
