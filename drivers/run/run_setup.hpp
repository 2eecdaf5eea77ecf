// From a configuration to everything a run needs: the one place where the chain is put together.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/config/option_needs.hpp"
#include "drivers/run/run_schedule.hpp"
#include "kernel/observables/observables.hpp"
#include "kernel/observables/resolved_boundary.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::run {

// Built in the order of the members; each is handed to the next by const reference.
struct RunSetup : RunSchedule {
  std::shared_ptr<const Communicator> ranks;
  std::shared_ptr<const ThreadTeam> team;
  std::shared_ptr<const fem::SurfaceSpace> space;
  std::unique_ptr<const problem::CahnHilliard> problem;
  Vec initial;              // projected c at the nodes
  double initial_mean = 0;  // and its mean
  observables::ResolvedBoundary boundary;
  std::unique_ptr<observables::Observer> observer;
  time::IntegratorPtr integrator;  // not started
};

enum class InitialState { build, from_checkpoint /* leaves RunSetup::initial empty */ };

// On all ranks of the program. Throws InputError for anything a run could not start with; creates
// no files.
// `compared`: of several runs, by which they differ.
RunSetup build_run(const config::Configuration& configuration, InitialState initial,
                   const config::Compared& compared = {});

// Computes the consistent state and hands it to the integrator.
Status start_run(RunSetup& setup);

}  // namespace traceraft::run
