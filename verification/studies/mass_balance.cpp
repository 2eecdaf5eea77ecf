// The mass ∫c does not drift: over seeds, surfaces, mobilities, integrators, linear solvers and
// ranks.
#include <algorithm>
#include <cmath>

#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "verification/bench/bench.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kBound = 1e-12;  // relative
constexpr double kEnough = 10;    // steps of a run
constexpr int kCells = 24;
constexpr double kEpsilon = 0.2, kFraction = 0.3, kTolerance = 1e-2;

double end_of_run(const bench::Bench& bench) {
  return bench.quick() ? 2 : 20;
}

struct Combination {
  std::string surface = "sphere", mobility = "degenerate", integrator, solver;
  std::uint64_t seed = 1;
  int ranks = 1;
};

// All combinations of integrators, solvers, surfaces and mobilities. With --quick surfaces and
// mobilities change with the first solver alone; other solvers have the first of both. Seeds change
// alone, and solvers on ranks have the first surface and mobility.
std::vector<Combination> combinations(const bench::Bench& bench) {
  const std::vector<std::string> on = {"sphere", "ellipsoid", "torus",
                                       "biconcave:middle=0.4,rim=0.7", "dziuk"};
  const std::vector<std::string> laws = {"degenerate", "constant:value=0.25"};
  std::vector<Combination> list;
  for (const std::string& integrator : bench.integrators())
    for (const std::string& solver : bench.linear_solvers())
      for (const std::string& surface : on)
        for (const std::string& mobility : laws) {
          const bool base = surface == on.front() && mobility == laws.front();
          const bool first = solver == bench.linear_solvers().front();
          if (!bench.quick() || base || first)
            list.push_back({surface, mobility, integrator, solver, 1});
        }
  for (std::uint64_t seed = 2; seed <= (bench.quick() ? 3 : 10); ++seed)
    list.push_back({on.front(), laws.front(), bench.integrator(), bench.linear_solver(), seed});
  for (const std::string& integrator : bench.integrators())
    for (const std::string& solver : bench.linear_solvers_on_ranks())
      list.push_back({on.front(), laws.front(), integrator, solver, 1, 2});
  return list;
}

struct Drift {
  double largest = 0;  // |m(t) − m(0)|/m(0) over all steps
  double steps = 0;
};

Drift drift_on_ranks(const bench::Bench& bench, const Combination& what) {
  const bench::ProgramRun run =
      bench.request.run_program({"--surface",       what.surface,
                                 "--mobility",      what.mobility,
                                 "--integrator",    what.integrator,
                                 "--linear-solver", what.solver,
                                 "--seed",          std::to_string(what.seed),
                                 "--cells",         std::to_string(kCells),
                                 "--epsilon",       format_number(kEpsilon),
                                 "--raft-fraction", format_number(kFraction),
                                 "--tolerance",     format_number(kTolerance),
                                 "--t-end",         format_number(end_of_run(bench))},
                                what.ranks, bench.space(what.surface, kCells)->nodes());
  return {run.mass_drift, run.steps};
}

Drift drift_of(const bench::Bench& bench, const Combination& what) {
  if (what.ranks > 1) return drift_on_ranks(bench, what);
  const bench::SpacePtr space = bench.space(geometry::make_surface(what.surface), kCells, 1);
  const bench::ProblemPtr problem =
      bench.problem(space, bench::bench_model(what.mobility, kEpsilon));
  problem::InitialRequest request;
  request.raft_fraction = kFraction;
  request.seed = what.seed;
  const bench::StartState start = bench::initial_state(*problem, "noise", request);
  time::IntegratorSettings settings;
  settings.tolerance = kTolerance;
  const time::IntegratorPtr integrator =
      bench.make_integrator(*problem, *space, what.integrator, what.solver, settings);
  const double mass = problem->mass(start.y);
  Drift drift;
  bench::advance_to(*integrator, start, end_of_run(bench), [&] {
    drift.largest =
        statistics::larger(drift.largest, std::fabs(problem->mass(integrator->state()) / mass - 1));
    ++drift.steps;
  });
  return drift;
}

StudyReport run(const bench::Bench& bench) {
  const std::vector<Combination> list = combinations(bench);
  bench::Table table{
      "drift",
      {"surface", "mobility", "integrator", "solver", "ranks", "seed", "steps", "drift"},
      {}};
  double largest = 0, largest_on_ranks = 0, steps = 0, fewest = HUGE_VAL;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Combination& what = list[k];
    const Drift drift = drift_of(bench, what);
    table.rows.push_back({what.surface, what.mobility, what.integrator, what.solver,
                          static_cast<double>(what.ranks), static_cast<double>(what.seed),
                          drift.steps, drift.largest});
    double& so_far = what.ranks > 1 ? largest_on_ranks : largest;
    so_far = statistics::larger(so_far, drift.largest);
    steps += drift.steps;
    fewest = std::min(fewest, drift.steps);
    bench.progress(static_cast<double>(k + 1) / static_cast<double>(list.size()));
  }
  StudyReport report;
  report.notes = {
      "The drift is the largest relative change of the mass over all accepted steps. The runs have "
      "24 cells, 30 % rafts from noise, epsilon = 0.2 R and tolerance 1e-2.",
      formatted("There are %zu runs with %.0f accepted steps.", list.size(), steps)};
  report.tables = {table};
  report.claims = {claim_at_most("largest relative drift of the mass", largest, kBound),
                   claim_at_least("fewest accepted steps of a run", fewest, kEnough)};
  if (!bench.linear_solvers_on_ranks().empty())
    report.claims.insert(
        report.claims.begin() + 1,
        claim_at_most("largest relative drift of the mass on two ranks", largest_on_ranks, kBound));
  return report;
}

}  // namespace

StudyEntry mass_balance_study() {
  return {"mass", "the mass is conserved: surfaces, mobilities, integrators, solvers, ranks, seeds",
          run, false, true};
}

}  // namespace traceraft::studies
