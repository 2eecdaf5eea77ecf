// Orders of convergence in the step size, on one mesh against a run with far smaller steps.
#include <cmath>
#include <memory>

#include "backends/list.hpp"
#include "verification/manufactured.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

constexpr double kEnd = 1.0;

Vec solve(const ManufacturedCahnHilliard& manufactured, const std::string& kept, int steps) {
  IntegratorSettings settings;
  settings.tolerance = 0.5;
  settings.initial_step = settings.max_step = kEnd / steps;
  settings.linear_tolerance = 1e-10;
  settings.kept_solution = kept;
  const SurfaceSpace& space = *manufactured.space;
  const IntegratorPtr integrator = integrators().find("euler").make(
      *manufactured.problem, choose_linear_solver("block", space), space.team, settings);
  return run_with_equal_steps(manufactured, *integrator, kEnd);
}

StudyReport run(const StudyRequest& request) {
  const auto space =
      std::make_shared<SurfaceSpace>(*make_surface("sphere"), 16, std::make_shared<ThreadTeam>(2),
                                     std::make_shared<SerialCommunicator>());
  const ManufacturedCahnHilliard manufactured(space, 0.3);
  const int finest = request.quick ? 80 : 320;
  StudyReport report;
  report.columns = {"steps", "first_order", "second_order"};
  const Vec reference = solve(manufactured, "second", 8 * finest);
  for (int steps = finest / 8; steps <= finest; steps *= 2) {
    std::vector<double> row = {static_cast<double>(steps)};
    for (const char* kept : {"first", "second"})
      row.push_back(manufactured.problem->norm(solve(manufactured, kept, steps) - reference));
    report.rows.push_back(row);
  }
  const auto& fine = report.rows.back();
  const auto& coarse = report.rows[report.rows.size() - 2];
  report.claims = {
      {"stabilised Euler: order in the step", std::log2(coarse[1] / fine[1]), 0.85, 1.15},
      {"stabilised BDF2: order in the step", std::log2(coarse[2] / fine[2]), 1.75, 2.25}};
  return report;
}

}  // namespace

StudyEntry time_order_study() {
  return {"time-order", "orders in the step size of the euler pair", run};
}

}  // namespace traceraft
