// Orders of convergence in the step size, on one mesh against a run with far smaller steps.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "backends/list.hpp"
#include "verification/manufactured.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

constexpr double kEnd = 1.0;

struct Method {
  const char* column;
  const char* claim;
  const char* integrator;
  const char* kept;  // euler only
  double order, margin;
};

const std::vector<Method>& methods() {
  static const std::vector<Method> list = {
      {"first_order", "stabilised Euler: order in the step", "euler", "first", 1, 0.15},
      {"second_order", "stabilised BDF2: order in the step", "euler", "second", 2, 0.25},
      {"ida_2", "ida at maximum order 2: order in the step", "ida", "", 2, 0.25},
      {"rosenbrock", "rosenbrock: order in the step", "rosenbrock", "", 3, 0.25}};
  return list;
}

Vec solve(const ManufacturedCahnHilliard& manufactured, const Method& method, int steps) {
  IntegratorSettings settings;
  settings.tolerance = 0.5;  // all steps of the size asked for
  settings.initial_step = settings.max_step = kEnd / steps;
  settings.linear_tolerance = 1e-12;
  settings.kept_solution = method.kept;
  if (method.integrator == std::string("ida")) settings.own["maxord"] = method.order;
  const SurfaceSpace& space = *manufactured.space;
  const IntegratorPtr integrator =
      integrators()
          .find(method.integrator)
          .make(*manufactured.problem, choose_linear_solver("block", space), space.team, settings);
  return run_with_equal_steps(manufactured, *integrator, kEnd);
}

StudyReport run(const StudyRequest& request) {
  const auto space =
      std::make_shared<SurfaceSpace>(*make_surface("sphere"), 16, std::make_shared<ThreadTeam>(2),
                                     std::make_shared<SerialCommunicator>());
  const ManufacturedCahnHilliard manufactured(space, 0.3);
  const int finest = request.quick ? 160 : 320;
  StudyReport report;
  report.columns = {"steps"};
  for (const Method& method : methods()) report.columns.push_back(method.column);
  const Vec reference = solve(manufactured, methods().back(), 4 * finest);
  for (int steps = finest / 8; steps <= finest; steps *= 2) {
    std::vector<double> row = {static_cast<double>(steps)};
    for (const Method& method : methods())
      row.push_back(manufactured.problem->norm(solve(manufactured, method, steps) - reference));
    report.rows.push_back(row);
  }
  for (std::size_t k = 0; k < methods().size(); ++k) {
    const double order = methods()[k].order;
    // The smallest errors of order 3, below 1e-10, are at the accuracy of the solves.
    const std::size_t fine = report.rows.size() - (order < 3 ? 1 : 2);
    report.claims.push_back({methods()[k].claim,
                             std::log2(report.rows[fine - 1][k + 1] / report.rows[fine][k + 1]),
                             order - methods()[k].margin, order + methods()[k].margin});
  }
  return report;
}

}  // namespace

StudyEntry time_order_study() {
  return {"time-order", "orders of the integrators in the step size", run};
}

}  // namespace traceraft
