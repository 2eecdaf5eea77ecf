// All integrators and linear solvers, on one and on two ranks, approach the same solution of one
// seeded run.
#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/core/parameters.hpp"
#include "verification/bench/bench.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr int kCells = 16;
constexpr double kEpsilon = 0.2, kFraction = 0.4;
constexpr double kEnd = 1;  // rafts have formed and begun to coarsen
// Solves to that accuracy leave next to nothing that solvers and ranks could differ by.
constexpr double kAccurate = 1e-10, kSame = 1e-7;

class Agreement {
 public:
  explicit Agreement(const bench::Bench& bench)
      : bench_(bench),
        space_(bench.space("sphere", kCells)),
        problem_(bench.problem(space_, bench::bench_model("degenerate", kEpsilon))) {
    problem::InitialRequest request;
    request.raft_fraction = kFraction;
    start_ = bench::initial_state(*problem_, "noise", request);
  }
  Vec solve(const std::string& integrator, const std::string& solver, double tolerance,
            double linear_tolerance) const {
    time::IntegratorSettings settings;
    settings.tolerance = tolerance;
    settings.linear_tolerance = linear_tolerance;
    const time::IntegratorPtr method =
        bench_.make_integrator(*problem_, *space_, integrator, solver, settings);
    bench::advance_to(*method, start_, kEnd);
    return method->state();
  }
  // The whole program, on ranks.
  Vec solve_on(int ranks, const std::string& integrator, const std::string& solver,
               double end) const {
    const bench::ProgramRun run = bench_.request.run_program(
        {"--integrator", integrator, "--linear-solver", solver, "--cells", std::to_string(kCells),
         "--epsilon", format_number(kEpsilon), "--raft-fraction", format_number(kFraction),
         "--tolerance", format_number(solver_tolerance()), "--linear-tolerance",
         format_number(kAccurate), "--t-end", format_number(end)},
        ranks, space_->nodes());
    Vec y = Vec::Zero(problem_->size());
    y.head(run.c.size()) = run.c;
    return y;
  }
  // At which solvers and ranks are compared.
  double solver_tolerance() const { return bench_.quick() ? 1e-3 : 1e-4; }
  // ‖c_a − c_b‖/‖c(0)‖ in L²(Γ).
  double distance(const Vec& a, const Vec& b) const {
    return problem_->norm(a - b) / problem_->norm(start_.y);
  }

 private:
  const bench::Bench& bench_;
  bench::SpacePtr space_;
  bench::ProblemPtr problem_;
  bench::StartState start_;
};

void compare_integrators(const bench::Bench& bench, const Agreement& runs, StudyReport& report) {
  const double tightest = bench.quick() ? 1e-5 : 1e-6;
  const std::string apart_from = "distance from ida at " + format_number(tightest);
  bench::Table table{"integrators", {"integrator", "tolerance", apart_from}, {}};
  bench::Chart chart{
      "Approach: " + apart_from, "tolerance", "relative, of c in L2", true, true, {}};
  const auto solve = [&](const std::string& name, double tolerance) {
    return runs.solve(name, bench.linear_solver(), tolerance, std::min(1e-4, tolerance));
  };
  const Vec reference = solve("ida", tightest);
  double apart = 0;
  bool compared = false;
  for (const std::string& name : bench.integrators()) {
    statistics::Points levels;
    for (double tolerance = 1e-2; tolerance > (bench.quick() ? 5e-4 : 5e-6); tolerance /= 10)
      levels.emplace_back(tolerance, runs.distance(solve(name, tolerance), reference));
    if (name != "ida") {
      levels.emplace_back(tightest, runs.distance(solve(name, tightest), reference));
      apart = statistics::larger(apart, levels.back().second);
      compared = true;
    }
    for (const auto& [tolerance, distance] : levels)
      table.rows.push_back({name, tolerance, distance});
    chart.series.push_back({name, levels});
  }
  if (compared)
    report.claims.push_back(
        claim_at_most("largest distance at tolerance " + format_number(tightest), apart,
                      2 * tightest));  // the sum of the two tolerances
  else
    report.notes.push_back(
        "Only ida was requested, so that there is no integrator to compare it with.");
  report.tables.push_back(table);
  report.charts.push_back(chart);
}

// Claims that computations of one thing differ by at most kSame. Nothing is claimed if there is
// none.
void claim_sameness(const std::string& what, double apart, const std::string& if_none,
                    const bench::Table& table, StudyReport& report) {
  if (table.rows.empty()) {
    report.notes.push_back(if_none);
    return;
  }
  report.claims.push_back(claim_at_most(what, apart, kSame));
  report.tables.push_back(table);
}

// Solvers with one integrator and one tolerance differ by what their solves leave over.
void compare_solvers(const bench::Bench& bench, const Agreement& runs, StudyReport& report) {
  bench::Table table{"solvers", {"integrator", "solver", "distance from direct"}, {}};
  const double tolerance = runs.solver_tolerance();
  double apart = 0;
  for (const std::string& name : bench.integrators()) {
    std::optional<Vec> reference;
    for (const std::string& solver : bench.linear_solvers()) {
      if (solver == "direct") continue;
      if (!reference) reference = runs.solve(name, "direct", tolerance, kAccurate);
      const double distance =
          runs.distance(runs.solve(name, solver, tolerance, kAccurate), *reference);
      table.rows.push_back({name, solver, distance});
      apart = statistics::larger(apart, distance);
    }
  }
  claim_sameness("largest distance between two solvers at tolerance " + format_number(tolerance),
                 apart,
                 "No other solver was requested, so that there is none to compare direct with.",
                 table, report);
}

void compare_ranks(const bench::Bench& bench, const Agreement& runs, StudyReport& report) {
  const double end = bench.quick() ? 0.1 : kEnd;  // many steps even so
  bench::Table table{"ranks", {"integrator", "solver", "distance of 2 ranks from 1"}, {}};
  double apart = 0;
  for (const std::string& solver : bench.linear_solvers_on_ranks())
    for (const std::string& name : bench.integrators()) {
      const double distance =
          runs.distance(runs.solve_on(2, name, solver, end), runs.solve_on(1, name, solver, end));
      table.rows.push_back({name, solver, distance});
      apart = statistics::larger(apart, distance);
    }
  claim_sameness("largest distance between 1 and 2 ranks at t = " + format_number(end), apart,
                 "This build has no solver that works on several ranks.", table, report);
}

StudyReport run(const bench::Bench& bench) {
  const Agreement runs(bench);
  StudyReport report;
  report.notes = {
      "The runs have 40 % rafts from noise, 16 cells, epsilon = 0.2 R and degenerate mobility. "
      "They end at t = 1, when rafts have formed and coarsen."};
  compare_integrators(bench, runs, report);
  bench.progress(0.6);
  compare_solvers(bench, runs, report);
  bench.progress(0.8);
  compare_ranks(bench, runs, report);
  return report;
}

}  // namespace

StudyEntry integrator_agreement_study() {
  return {"agreement", "integrators, linear solvers and ranks approach one solution", run, false,
          true};
}

}  // namespace traceraft::studies
