// Two rafts on a torus, a few steps: what a user of the library writes.
#include <cstdio>

#include "backends/list.hpp"
#include "kernel/observables/observables.hpp"
#include "kernel/problem/initial_data.hpp"

using namespace traceraft;

int main() {
  const auto team = std::make_shared<ThreadTeam>(2);
  const auto space = std::make_shared<fem::SurfaceSpace>(geometry::make_surface("torus"), 24, team,
                                                         std::make_shared<SerialCommunicator>());
  problem::CahnHilliardModel model;
  model.mobility = physics::make_mobility("degenerate");
  model.epsilon = 0.2;
  const problem::CahnHilliard equation(space, model);

  Vec y = Vec::Zero(equation.size()), ydot(equation.size());
  y.head(equation.block_size()) = problem::make_initial_field("noise", *space, {});
  if (!equation.consistent_initial_state(0, y, ydot).ok()) return 1;

  const time::IntegratorPtr integrator = backends::integrators().find("euler").make(
      equation, backends::choose_linear_solver("block", *space), team, {});
  if (!integrator->start(0, y, ydot, 1.0).ok()) return 1;
  while (integrator->time() < 1.0)
    if (!integrator->advance().ok()) return 1;
  const observables::Observables row =
      observables::Observer(equation, space, model.well.interface_energy())
          .measure(1.0, integrator->state());
  std::printf("rafts %d, mass %.12g\n", row.rafts, row.mass);
  return row.rafts > 0 ? 0 : 1;
}
