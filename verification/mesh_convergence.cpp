// Orders of convergence in the mesh size h: stationary problem and full time-dependent system.
#include <cmath>
#include <memory>

#include "backends/list.hpp"
#include "verification/manufactured.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

std::shared_ptr<const SurfaceSpace> sphere_space(int cells) {
  return std::make_shared<SurfaceSpace>(*make_surface("sphere"), cells,
                                        std::make_shared<ThreadTeam>(2),
                                        std::make_shared<SerialCommunicator>());
}

struct SystemErrors {
  ErrorNorms c, mu;
};

SystemErrors system_error(std::shared_ptr<const SurfaceSpace> space, double t_end, int steps) {
  const ManufacturedCahnHilliard manufactured(space, 0.3);
  IntegratorSettings settings;
  settings.tolerance = 0.5;
  settings.initial_step = settings.max_step = t_end / steps;
  settings.linear_tolerance = 1e-8;
  const IntegratorPtr integrator = integrators().find("euler").make(
      *manufactured.problem, choose_linear_solver("block", *space), space->team, settings);
  const Vec y = run_with_equal_steps(manufactured, *integrator, t_end);
  return {error_norms(*space, manufactured.problem->c_of(y), manufactured.c(t_end)),
          error_norms(*space, manufactured.problem->mu_of(y), manufactured.mu(t_end))};
}

double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

StudyReport run(const StudyRequest& request) {
  StudyReport report;
  report.columns = {"cells", "h", "L2", "H1", "c_L2", "c_H1", "mu_L2", "mu_H1"};
  const int finest = request.quick ? 32 : 128;
  constexpr double kEnd = 0.5;
  for (int cells = 8; cells <= finest; cells *= 2) {
    const auto space = sphere_space(cells);
    const ErrorNorms stationary = stationary_error(*space);
    // Δt falls with h, so that the error in time falls with h² as well and stays small beside it.
    const SystemErrors system = system_error(space, kEnd, 5 * cells);
    report.rows.push_back({static_cast<double>(cells), space->h(), stationary.l2, stationary.h1,
                           system.c.l2, system.c.h1, system.mu.l2, system.mu.h1});
  }
  const auto& fine = report.rows.back();
  const auto& coarse = report.rows[report.rows.size() - 2];
  const auto claim = [&](const char* what, int column, double expected, double slack) {
    report.claims.push_back(
        {what, order(coarse[column], fine[column]), expected - slack, expected + slack});
  };
  claim("stationary problem: order in L2", 2, 2, 0.15);
  claim("stationary problem: order in H1", 3, 1, 0.15);
  claim("full system: order of c in L2", 4, 2, 0.25);
  claim("full system: order of c in H1", 5, 1, 0.25);
  claim("full system: order of mu in L2", 6, 2, 0.25);
  claim("full system: order of mu in H1", 7, 1, 0.25);
  return report;
}

}  // namespace

StudyEntry mesh_convergence_study() {
  return {"convergence", "orders in the mesh size: manufactured solutions on the sphere", run};
}

}  // namespace traceraft
