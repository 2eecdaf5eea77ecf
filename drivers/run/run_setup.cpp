#include "drivers/run/run_setup.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <thread>

#include "backends/list.hpp"
#include "backends/ranks.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/initial_state.hpp"
#include "drivers/run/memory_need.hpp"
#include "drivers/run/numerical_methods.hpp"
#include "drivers/run/physical_model.hpp"
#include "drivers/run/run_mesh.hpp"
#include "kernel/core/text.hpp"
#include "kernel/simulation/adapted_mesh.hpp"

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

// All that depends on the mesh but the mesh itself. Refers to the configuration.
simulation::MeshAdaptation::MakeRest rest_of(const config::Configuration& configuration,
                                             const RunSetup& run,
                                             const problem::CahnHilliardModel& physics,
                                             const backends::IntegratorEntry& integrator,
                                             const time::IntegratorSettings& settings) {
  return [&configuration, &integrator, physics, settings, team = run.team,
          energy = run.boundary.interface_energy](std::shared_ptr<const fem::SurfaceSpace> space) {
    simulation::Discretisation on;
    on.problem = std::make_unique<problem::CahnHilliard>(space, physics);
    on.observer = std::make_unique<observables::Observer>(*on.problem, space, energy);
    on.integrator =
        integrator.make(*on.problem, linear_solver(configuration, *space), team, settings);
    on.space = std::move(space);
    return on;
  };
}

// The mesh that follows the boundaries, and the initial state on it.
mesh::RefinementForest begin_adaptive(const config::Configuration& configuration,
                                      const geometry::LevelSetPtr& surface,
                                      const problem::CahnHilliardModel& physics,
                                      const InitialState& initial,
                                      const simulation::MakeSpace& make_space, RunSetup& run) {
  const mesh::RefinementLevels levels = refinement_levels(configuration, *surface);
  if (!initial.from_checkpoint && !begins_finest(configuration)) {
    const fem::RefinementRule rule =
        simulation::boundary_rule(physics, levels, configuration.options().mesh_threshold);
    simulation::FieldOnMesh begin = simulation::adapted_field(
        *surface, levels, rule, make_space, initial_field(configuration, physics));
    run.space = std::move(begin.space);
    run.initial = std::move(begin.field);
    return std::move(begin.forest);
  }
  mesh::RefinementForest forest =
      initial.from_checkpoint
          ? mesh::RefinementForest(*surface, levels, initial.forest)
          : mesh::RefinementForest(*surface, levels, levels.finest_generation());
  run.space = make_space(mesh::build_active_mesh(*surface, forest));
  return forest;
}

}  // namespace

RunSetup build_run(const config::Configuration& configuration, const InitialState& initial,
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
  const bool adaptive = is_adaptive(configuration, physics, *run.ranks);
  if (begins_finest(configuration)) refuse_too_fine(configuration, *surface, *run.ranks);
  const simulation::MakeSpace make_space = [surface, team = run.team, ranks = run.ranks,
                                            mass =
                                                physics.mass_stabilisation](mesh::ActiveMesh mesh) {
    return std::make_shared<const fem::SurfaceSpace>(surface, std::move(mesh), team, ranks, mass);
  };
  std::optional<mesh::RefinementForest> forest;
  if (adaptive)
    forest = begin_adaptive(configuration, surface, physics, initial, make_space, run);
  else
    run.space = with_option_context(configuration, &config::RunOptions::surface, [&] {
      return make_space(
          mesh::build_active_mesh(*surface, configuration.options().cells, *run.ranks));
    });
  with_option_context(configuration, &config::RunOptions::effect, [&] {
    for (const problem::EffectPtr& effect : physics.effects) effect->require_surface(*run.space);
    return 0;
  });
  if (!initial.from_checkpoint) {
    if (run.initial.size() == 0) run.initial = initial_field(configuration, physics)(*run.space);
    run.initial_mean = run.space->integral(run.initial) / run.space->area;
  }
  run.boundary = observables::resolved_boundary(physics, run.space->h());
  const auto make_rest = rest_of(configuration, run, physics, integrator, settings);
  static_cast<simulation::Discretisation&>(run) = make_rest(run.space);
  if (settings.reject_energy_rises && !run.problem->dissipates_energy())
    throw InputError(configuration.where(&config::RunOptions::energy_guard) +
                     ": reject needs a model that can only lose energy, and this one may gain "
                     "energy; choose warn or off");
  // A configuration file holds the default, too, in place of which euler keeps its first.
  if (configuration.from_flag(&config::RunOptions::keep) && settings.kept_solution == "second" &&
      !run.problem->may_be_extrapolated())
    throw InputError(configuration.where(&config::RunOptions::keep) +
                     ": with these effects the second-order solution of euler is unstable; leave "
                     "the choice to it");
  if (forest) {
    const fem::RefinementRule rule = simulation::boundary_rule(
        physics, forest->levels(), configuration.options().mesh_threshold);
    run.adaptation =
        std::make_unique<simulation::MeshAdaptation>(std::move(*forest), rule, make_rest);
  }
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
