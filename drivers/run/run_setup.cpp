#include "drivers/run/run_setup.hpp"

#include <algorithm>
#include <functional>
#include <thread>

#include "backends/list.hpp"
#include "backends/ranks.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/initial_state.hpp"
#include "drivers/run/memory_need.hpp"
#include "drivers/run/numerical_methods.hpp"
#include "drivers/run/physical_model.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::run {
namespace {

int thread_count(const config::Configuration& configuration, const Communicator& ranks) {
  const int asked = static_cast<int>(configuration.options().threads);
  if (ranks.size() > 1) {
    // A run of one rank may have had two, and goes on with more ranks.
    if (asked > 1 && configuration.from_flag(&config::RunOptions::threads))
      throw InputError(configuration.where(&config::RunOptions::threads) +
                       ": with several ranks each has one thread; start more ranks instead");
    return 1;
  }
  if (asked > 0) return asked;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 2);
}

}  // namespace

RunSetup build_run(const config::Configuration& configuration, InitialState initial,
                   const config::Compared& compared) {
  RunSetup run;
  static_cast<RunSchedule&>(run) = run_schedule(configuration);
  const problem::CahnHilliardModel physics = physical_model(configuration);
  const backends::IntegratorEntry& integrator = with_option_context(
      configuration, &config::RunOptions::integrator,
      [&] { return std::cref(backends::integrators().find(configuration.options().integrator)); });
  const time::IntegratorSettings settings =
      integrator_settings(configuration, integrator, run.units);
  with_option_context(configuration, &config::RunOptions::linear_solver, [&] {
    return backends::linear_solvers().find(configuration.options().linear_solver).name;
  });
  config::refuse_idle_options(configuration, compared);

  run.ranks = backends::world();
  run.team = std::make_shared<ThreadTeam>(thread_count(configuration, *run.ranks));
  const geometry::LevelSetPtr surface = surface_of(configuration);
  refuse_too_fine(configuration, *surface, *run.ranks);
  run.space = with_option_context(configuration, &config::RunOptions::surface, [&] {
    return std::make_shared<const fem::SurfaceSpace>(
        surface, configuration.options().cells, run.team, run.ranks, physics.mass_stabilisation);
  });
  with_option_context(configuration, &config::RunOptions::effect, [&] {
    for (const problem::EffectPtr& effect : physics.effects) effect->require_surface(*run.space);
    return 0;
  });
  run.problem = std::make_unique<problem::CahnHilliard>(run.space, physics);
  if (settings.reject_energy_rises && !run.problem->dissipates_energy())
    throw InputError(configuration.where(&config::RunOptions::energy_guard) +
                     ": reject needs a model that can only lose energy, and this one may gain "
                     "energy; choose warn or off");
  if (initial == InitialState::build) {
    run.initial = initial_field(configuration, physics, *run.space);
    run.initial_mean = run.space->integral(run.initial) / run.space->area;
  }
  run.boundary = observables::resolved_boundary(physics, run.space->h());
  run.observer = std::make_unique<observables::Observer>(*run.problem, run.space,
                                                         run.boundary.interface_energy);
  const linear::LinearSolverChoice solvers = linear_solver(configuration, *run.space);
  run.integrator = integrator.make(*run.problem, solvers, run.team, settings);
  return run;
}

Status start_run(RunSetup& run) {
  Vec y(run.problem->size()), ydot(run.problem->size());
  y.head(run.problem->block_size()) = run.initial;
  if (Status status = run.problem->consistent_initial_state(0, y, ydot); !status.ok())
    return status;
  return run.integrator->start(0, y, ydot, run.t_end);
}

}  // namespace traceraft::run
