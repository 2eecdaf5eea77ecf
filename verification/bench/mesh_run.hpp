// A run of a study on a uniform mesh, or on one that follows the boundaries.
#pragma once

#include <optional>

#include "kernel/simulation/mesh_adaptation.hpp"
#include "verification/bench/bench.hpp"

namespace traceraft::bench {

struct MeshRunRequest {
  std::string surface = "sphere";
  problem::CahnHilliardModel model;
  int cells = 64;         // per edge of the box, of the smallest tetrahedra
  bool adaptive = false;  // may others be larger?
  int threads = 1;
  double tolerance = 0;  // of the bench's integrator; 0: its own
  double t_end = 1;
  std::function<Vec(const fem::SurfaceSpace&)> field;  // c at the beginning
};

// Throws std::runtime_error where a computation fails.
class MeshRun {
 public:
  MeshRun(const Bench& bench, const MeshRunRequest& request);

  void step();
  bool finished() const { return !(on_.integrator->time() < request_.t_end); }

  // The present mesh and what is on it.
  const simulation::Discretisation& on() const { return on_; }
  // The changes of a mesh that follows. Nodes and steps are counted on any mesh.
  simulation::RemeshStatistics meshes() const;

 private:
  simulation::Discretisation rest_on(SpacePtr space) const;
  Vec begin_adaptive();

  const Bench& bench_;
  const MeshRunRequest request_;
  simulation::Discretisation on_;
  std::optional<simulation::MeshAdaptation> adaptation_;
  double node_steps_ = 0, steps_ = 0;
};

}  // namespace traceraft::bench
