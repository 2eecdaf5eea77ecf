// GMRES iterations of the block solver with fresh factors, over meshes, cuts, step sizes, widths
// and mobilities.
#include <algorithm>

#include "backends/list.hpp"
#include "verification/bench/bench.hpp"
#include "verification/bench/motion.hpp"
#include "verification/bench/shift_range.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

// The stabilised tangent is solved to what euler asks for, the exact one to a fifth of what ida
// asks for.
constexpr double kTolerance[2] = {1e-4, 1e-2};
// The exact Jacobian of a step far longer than the state allows is indefinite. What is claimed of
// it is for steps up to twice the one that ida takes there, as it at most doubles a step.
constexpr double kLongestStep = 2;

constexpr double kHardest = 0.01;  // of the widths: the least for the mesh

enum class State { coarsening, late };  // many rafts; one large and one small

struct StudiedState {
  Vec y;
  double step;  // that ida takes there
};

StudiedState state_at(const bench::Bench& bench, const problem::CahnHilliard& problem, State state,
                      double t_end) {
  problem::InitialRequest request;
  request.raft_fraction = 0.3;
  request.noise_cells = 16;
  request.caps = {{Point(0, 0, 1), 0.9}, {Point(1, 2, -3).normalized(), 0.4}};
  time::IntegratorSettings settings;
  settings.tolerance = 1e-2;
  const time::IntegratorPtr ida =
      bench.make_integrator(problem, problem.space(), "ida", "block", settings);
  bench::advance_to(
      *ida, bench::initial_state(problem, state == State::late ? "caps" : "noise", request), t_end);
  return {ida->state(), ida->next_step()};
}

// −F(y, 0): what the first correction of a step from y solves with.
Vec right_side(const problem::CahnHilliard& problem, const Vec& y) {
  Vec r(problem.size());
  bench::require(problem.residual(0, y, Vec::Zero(y.size()), r));
  return -r;
}

// −1: the fallback would be needed.
double iterations(const problem::CahnHilliard& problem, const Vec& y, const Vec& b, double shift,
                  linear::Tangent tangent) {
  const linear::LinearSolverPtr solver =
      backends::linear_solvers().find("block").make(problem.space(), {})(1);
  linear::BlockJacobian J = problem.make_jacobian();
  bench::require(problem.jacobian(0, y, Vec::Zero(y.size()), shift, tangent, J));
  bench::require(solver->setup(J));
  Vec x = Vec::Zero(b.size());
  const linear::SolveReport report =
      solver->solve(J, b, x, kTolerance[tangent == linear::Tangent::exact]);
  return report.status.ok() ? report.iterations : -1;
}

struct Most {
  double iterations[2] = {0, 0};  // stabilised, exact
  double failures = 0;
};

// A row for each tangent at one state.
void measure(const bench::Bench& bench, const problem::CahnHilliard& problem,
             const std::string& mobility, State state, bench::Table& table, Most& most) {
  const StudiedState sample = state_at(bench, problem, state, 5);
  const Vec b = right_side(problem, sample.y);
  for (const linear::Tangent tangent : {linear::Tangent::stabilised, linear::Tangent::exact}) {
    const bool exact = tangent == linear::Tangent::exact;
    std::vector<bench::Cell> row = {state == State::late ? "late" : "coarsening",
                                    exact ? "exact" : "stabilised",
                                    mobility,
                                    static_cast<double>(problem.space().mesh.cube.cells),
                                    problem.model().epsilon,
                                    sample.step};
    for (const double shift : bench::shift_range()) {
      const bool claimed = !exact || 1 / shift <= kLongestStep * sample.step;
      // Where nothing is claimed they are hundreds, and take most of the time.
      if (!claimed && bench.quick()) {
        row.push_back("");
        continue;
      }
      const double count = iterations(problem, sample.y, b, shift, tangent);
      row.push_back(count);
      if (!claimed) continue;
      if (count < 0) ++most.failures;
      most.iterations[exact] = std::max(most.iterations[exact], count);
    }
    table.rows.push_back(row);
  }
}

// The sphere turned and shifted against the mesh, while rafts coarsen there.
void measure_cuts(const bench::Bench& bench, StudyReport& report) {
  constexpr int kCells = 32;
  const int count = bench.quick() ? 6 : 50;
  const std::vector<double> shifts = bench::shift_range();
  std::vector<std::vector<double>> of_cut(static_cast<std::size_t>(count));
  bench.in_parallel(count, [&](int k) {
    const bench::Motion motion(static_cast<std::uint64_t>(k) + 1, 0.5 * 10 / 3 / kCells);
    const bench::ProblemPtr problem = bench.problem(
        bench.space(bench::moved(geometry::make_surface("sphere"), motion), kCells, 1),
        bench::bench_model("degenerate", 0.05));
    const Vec y = state_at(bench, *problem, State::coarsening, 5).y, b = right_side(*problem, y);
    for (const double shift : shifts)
      of_cut[k].push_back(iterations(*problem, y, b, shift, linear::Tangent::stabilised));
  });
  bench::Table table{"cuts", {std::to_string(count) + " cuts"}, {{"fewest"}, {"mean"}, {"most"}}};
  double most = 0, fewest = 1e9;
  for (std::size_t s = 0; s < shifts.size(); ++s) {
    std::vector<double> values;
    for (const auto& cut : of_cut) values.push_back(cut[s]);
    const statistics::Sample m = statistics::sample_of(values);
    table.columns.push_back(bench::shift_label(shifts[s]));
    table.rows[0].push_back(m.min);
    table.rows[1].push_back(m.mean);
    table.rows[2].push_back(m.max);
    most = std::max(most, m.max);
    fewest = std::min(fewest, m.min);
  }
  report.tables.push_back(table);
  report.claims.push_back(
      claim_between("random positions of the surface: most iterations to 1e-4", most, 1, 25));
  report.claims.push_back(
      claim_between("random positions of the surface: fewest iterations", fewest, 0, most));
}

StudyReport measure_meshes(const bench::Bench& bench, int coarsest, int finest) {
  bench::Table table{
      "iterations", {"state", "tangent", "mobility", "cells", "epsilon", "ida_step"}, {}};
  for (const double shift : bench::shift_range())
    table.columns.push_back(bench::shift_label(shift));
  Most most;
  for (int cells = coarsest; cells <= finest; cells *= 2) {
    const bench::SpacePtr space = bench.space("sphere", cells);
    for (const double epsilon : {0.01, 0.02, 0.05}) {
      for (const char* mobility : {"degenerate", "constant:value=0.25"}) {
        // The degenerate law is the harder one.
        if (cells > coarsest && mobility != std::string("degenerate")) continue;
        if (cells > coarsest && bench.quick() && epsilon > kHardest) continue;
        const bench::ProblemPtr problem =
            bench.problem(space, bench::bench_model(mobility, epsilon));
        for (const State state : {State::coarsening, State::late})
          measure(bench, *problem, mobility, state, table, most);
      }
    }
    bench.progress(static_cast<double>(cells * cells) / (finest * finest));
  }
  StudyReport report;
  report.notes = {
      "Numbers are iterations of GMRES in the solver block, with fresh factors. The shift s, in "
      "units of D/R^2, is about the inverse of the step. The number -1 means that the limit of "
      "iterations was reached. The claim about the exact tangent covers steps up to twice that of "
      "ida at this state. Longer steps are measured only without --quick."};
  report.tables = {table};
  report.claims = {
      claim_between("stabilised tangent: most iterations to 1e-4", most.iterations[0], 1, 25),
      claim_between("exact tangent, up to twice ida's step: most iterations to 1e-2",
                    most.iterations[1], 1, 25),
      claim_at_most("solves that need the fallback solver", most.failures, 0)};
  if (finest <= 128) measure_cuts(bench, report);
  return report;
}

}  // namespace

StudyEntry solver_iterations_study() {
  return {"iterations", "GMRES iterations over meshes, cuts, shifts, widths and mobilities",
          [](const bench::Bench& bench) {
            return measure_meshes(bench, 32, bench.quick() ? 64 : 128);
          }};
}

StudyEntry large_solver_iterations_study() {
  return {"iterations-large", "iterations on a fine mesh: takes a quarter of an hour",
          [](const bench::Bench& bench) { return measure_meshes(bench, 256, 256); }, true};
}

}  // namespace traceraft::studies
