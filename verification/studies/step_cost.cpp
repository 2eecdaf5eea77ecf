// The cost of a step of the euler integrator on one core and on two.
#include <algorithm>
#include <numeric>

#include "kernel/core/stopwatch.hpp"
#include "kernel/core/text.hpp"
#include "verification/bench/bench.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

double epsilon_on(int cells) {
  return 1.28 / cells;  // 0.01 on 128
}

// One run that is advanced step by step, beside others.
struct TimedRun {
  std::string solver;
  bench::SpacePtr space;
  bench::ProblemPtr problem;
  time::IntegratorPtr integrator;
  std::vector<double> steps;

  TimedRun(const bench::Bench& bench, int cells, int threads, std::string solver_)
      : solver(std::move(solver_)),
        space(bench.space(geometry::make_surface("sphere"), cells, threads)),
        problem(bench.problem(space, bench::bench_model("degenerate", epsilon_on(cells)))),
        integrator(bench.make_integrator(*problem, *space, "euler", solver, {})) {
    problem::InitialRequest request;
    request.raft_fraction = 0.16;
    request.noise_cells = cells / 4;
    const bench::StartState start = bench::initial_state(*problem, "noise", request);
    bench::require(integrator->start(0, start.y, start.ydot, 1e6));
  }
  void advance() {
    const Stopwatch watch;
    bench::require(integrator->advance());
    steps.push_back(watch.seconds());
  }
  double mean() const {
    return std::accumulate(steps.begin(), steps.end(), 0.0) / static_cast<double>(steps.size());
  }
  // Milliseconds per step.
  std::vector<bench::Cell> row() {
    std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
    const double count = static_cast<double>(steps.size());
    const linear::LinearStatistics linear = integrator->linear_statistics();
    const double assembly = integrator->statistics().assembly_seconds;
    return {solver,
            static_cast<double>(space->team->size()),
            count,
            1e3 * steps[steps.size() / 2],
            1e3 * mean(),
            1e3 * assembly / count,
            1e3 * linear.setup_seconds / count,
            1e3 * linear.solve_seconds / count,
            static_cast<double>(linear.iterations) / static_cast<double>(linear.solves)};
  }
};

StudyReport run(const bench::Bench& bench) {
  const int cells = bench.quick() ? 48 : 128, steps = bench.quick() ? 20 : 120;
  // Taken in turn, so that all see the same machine.
  TimedRun one(bench, cells, 1, "block"), two(bench, cells, 2, "block");
  TimedRun direct_one(bench, cells, 1, "direct"), direct_two(bench, cells, 2, "direct");
  for (int step = 0; step < steps; ++step) {
    one.advance();
    two.advance();
    if (step % 6 == 0) {
      direct_one.advance();
      direct_two.advance();
    }
    bench.progress(static_cast<double>(step + 1) / steps);
  }
  StudyReport report;
  report.notes = {
      formatted("The surface is a sphere on %d cells with epsilon = %g R. The times of the parts "
                "of a step are summed over threads. Runs on one and on two cores alternate. The "
                "claims need two cores without other load.",
                cells, epsilon_on(cells))};
  report.tables = {{"steps",
                    {"solver", "threads", "steps", "median_ms", "mean_ms", "assembly_ms",
                     "setup_ms", "solve_ms", "iterations"},
                    {one.row(), two.row(), direct_one.row(), direct_two.row()}}};
  report.claims = {
      claim_between("block: time on one core / time on two", one.mean() / two.mean(), 1.2, 2.2),
      claim_between("direct: time on one core / time on two", direct_one.mean() / direct_two.mean(),
                    1.2, 2.2),
      claim_between("one core: time of direct / time of block", direct_one.mean() / one.mean(), 2,
                    1e3)};
  return report;
}

}  // namespace

StudyEntry step_cost_study() {
  return {"step-cost", "time of an euler step: one core, two cores, block and direct", run, true};
}

}  // namespace traceraft::studies
