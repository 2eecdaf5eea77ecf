// What a step of the euler integrator costs on one core and on two.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "backends/list.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/problem/initial_data.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

void require(const Status& status) {
  if (!status.ok()) throw std::runtime_error("step-cost: " + status.why);
}

// One run that is advanced step by step, beside others.
struct TimedRun {
  std::shared_ptr<const ThreadTeam> team;
  std::shared_ptr<const SurfaceSpace> space;
  std::unique_ptr<CahnHilliard> problem;
  IntegratorPtr integrator;
  std::vector<double> steps;

  TimedRun(int cells, int threads, const std::string& solver)
      : team(std::make_shared<ThreadTeam>(threads)),
        space(std::make_shared<SurfaceSpace>(*make_surface("sphere"), cells, team,
                                             std::make_shared<SerialCommunicator>())) {
    CahnHilliardModel model;
    model.mobility = make_mobility("degenerate");
    model.epsilon = 1.28 / cells;  // 0.01 at n = 128
    problem = std::make_unique<CahnHilliard>(space, model);
    Vec y = Vec::Zero(problem->size()), ydot = Vec::Zero(problem->size());
    InitialRequest request;
    request.raft_fraction = 0.16;
    request.noise_cells = cells / 4;
    y.head(problem->block_size()) = make_initial_field("noise", *space, request);
    require(problem->consistent_initial_state(0, y, ydot));
    integrator =
        integrators().find("euler").make(*problem, choose_linear_solver(solver, *space), team, {});
    require(integrator->start(0, y, ydot, 1e6));
  }
  void advance() {
    const Stopwatch watch;
    require(integrator->advance());
    steps.push_back(watch.seconds());
  }
  std::vector<double> row(double solver) {
    std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
    const double count = static_cast<double>(steps.size());
    double total = 0;
    for (const double step : steps) total += step;
    const LinearStatistics linear = integrator->linear_statistics();
    const double assembly = integrator->statistics().assembly_seconds;
    return {solver,
            static_cast<double>(team->size()),
            count,
            1e3 * steps[steps.size() / 2],
            1e3 * total / count,
            1e3 * assembly / count,
            1e3 * linear.setup_seconds / count,
            1e3 * linear.solve_seconds / count,
            static_cast<double>(linear.iterations) / static_cast<double>(linear.solves)};
  }
};

StudyReport run(const StudyRequest& request) {
  const int cells = request.quick ? 48 : 128, steps = request.quick ? 20 : 120;
  StudyReport report;
  // solver 0: block, 1: direct. Parts are summed over threads.
  report.columns = {"solver",      "threads",  "steps",    "median_ms", "mean_ms",
                    "assembly_ms", "setup_ms", "solve_ms", "iterations"};
  // Taken in turn, so that all see the same machine.
  TimedRun one(cells, 1, "block"), two(cells, 2, "block");
  TimedRun direct_one(cells, 1, "direct"), direct_two(cells, 2, "direct");
  for (int step = 0; step < steps; ++step) {
    one.advance();
    two.advance();
    if (step % 6 == 0) {
      direct_one.advance();
      direct_two.advance();
    }
  }
  report.rows = {one.row(0), two.row(0), direct_one.row(1), direct_two.row(1)};
  report.claims = {
      {"block: time on one core over time on two", report.rows[0][4] / report.rows[1][4], 1.2, 2.2},
      {"direct: time on one core over time on two", report.rows[2][4] / report.rows[3][4], 1.2,
       2.2},
      {"one core: time of direct over time of block", report.rows[2][4] / report.rows[0][4], 2,
       1e3}};
  return report;
}

}  // namespace

StudyEntry step_cost_study() {
  return {"step-cost", "time of an euler step: one core, two cores, block and direct", run, true};
}

}  // namespace traceraft
