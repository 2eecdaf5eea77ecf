// From a configuration to everything a run needs: the one place where the chain is put together.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/config/option_needs.hpp"
#include "drivers/run/run_schedule.hpp"
#include "kernel/observables/resolved_boundary.hpp"
#include "kernel/simulation/mesh_adaptation.hpp"

namespace traceraft::run {

// The discretisation changes where a mesh follows the boundaries.
struct RunSetup : RunSchedule, simulation::Discretisation {
  std::shared_ptr<const Communicator> ranks;
  std::shared_ptr<const ThreadTeam> team;
  Vec initial;              // projected c at the nodes
  double initial_mean = 0;  // and its mean
  observables::ResolvedBoundary boundary;
  std::unique_ptr<simulation::MeshAdaptation> adaptation;  // none on a uniform mesh
};

// Where a run begins: with its initial state, or with the state of a checkpoint, which leaves
// RunSetup::initial empty.
struct InitialState {
  bool from_checkpoint = false;
  std::vector<bool> forest{};  // of the checkpoint's mesh, as bits; none on a uniform mesh
};

// On all ranks of the program; the integrator is not started. Throws InputError for anything a run
// could not start with; creates no files.
// `compared`: of several runs, by which they differ.
RunSetup build_run(const config::Configuration& configuration, const InitialState& initial = {},
                   const config::Compared& compared = {});

// Computes the consistent state and hands it to the integrator.
Status start_run(RunSetup& setup);

}  // namespace traceraft::run
