// Keeps the mesh of a run fine along the phase boundaries while they move.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/fem/refinement_rule.hpp"
#include "kernel/mesh/refinement_forest.hpp"
#include "kernel/simulation/discretisation.hpp"

namespace traceraft::simulation {

// The changes of meshes in a run.
struct RemeshStatistics {
  long remeshes = 0;
  double highest_jump = 0, lowest_jump = 0;  // of the energy, over that before the jump
  double node_steps = 0, steps = 0;          // Σ over steps of the nodes at them, and of 1
  double seconds = 0;                        // of indicators, new meshes and transfers

  double mean_nodes() const { return node_steps / std::max(1.0, steps); }
};

// Decisions depend on accepted states and counters alone, so that a run that goes on from a
// checkpoint repeats them.
class MeshAdaptation {
 public:
  // Everything else on a space; the integrator is not started.
  using MakeRest = std::function<Discretisation(std::shared_ptr<const fem::SurfaceSpace>)>;

  // `forest`: of the mesh that the run is on.
  MeshAdaptation(mesh::RefinementForest forest, const fem::RefinementRule& rule,
                 MakeRest make_rest);

  const mesh::RefinementForest& forest() const { return forest_; }
  const RemeshStatistics& statistics() const { return statistics_; }

  // To be called before each step with the run's discretisation. Where the mesh has to follow, the
  // discretisation becomes one on a new mesh, and its integrator goes on as before: the mass is
  // kept, energies and observables are those of the new mesh. fatal: why it could not go on.
  Status before_step(Discretisation& on);

  // Counters; the forest is saved by its bits.
  void save(CheckpointOut out) const;
  void load(CheckpointIn in);

 private:
  Status move_to(Discretisation& on, mesh::RefinementForest forest, mesh::ActiveMesh mesh);

  mesh::RefinementForest forest_;
  std::vector<int> generation_;  // of its leaves
  const fem::RefinementRule rule_;
  MakeRest make_rest_;
  RemeshStatistics statistics_;
  int steps_since_ = 0;  // the last look for what can be saved
};

}  // namespace traceraft::simulation
