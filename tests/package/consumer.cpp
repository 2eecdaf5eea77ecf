// Two rafts on a torus, a few steps: what a user of the library writes.
#include <cstdio>

#include "backends/list.hpp"
#include "kernel/observables/observables.hpp"
#include "kernel/problem/initial_data.hpp"

using namespace traceraft;

int main() {
  const auto team = std::make_shared<ThreadTeam>(2);
  const auto space = std::make_shared<SurfaceSpace>(*make_surface("torus"), 24, team,
                                                    std::make_shared<SerialCommunicator>());
  CahnHilliardModel model;
  model.mobility = make_mobility("degenerate");
  model.epsilon = 0.2;
  const CahnHilliard problem(space, model);

  Vec y = Vec::Zero(problem.size()), ydot(problem.size());
  y.head(problem.block_size()) = make_initial_field("noise", *space, {});
  if (!problem.consistent_initial_state(0, y, ydot).ok()) return 1;

  const IntegratorPtr integrator =
      integrators().find("euler").make(problem, choose_linear_solver("block", *space), team, {});
  if (!integrator->start(0, y, ydot, 1.0).ok()) return 1;
  while (integrator->time() < 1.0)
    if (!integrator->advance().ok()) return 1;
  const Observables row =
      Observer(problem, space, model.well.interface_energy()).measure(1.0, integrator->state());
  std::printf("rafts %d, mass %.12g\n", row.rafts, row.mass);
  return row.rafts > 0 ? 0 : 1;
}
