// Two rafts on a sphere, of which the smaller one vanishes: when, and what that takes to compute.
#pragma once

#include "verification/bench/mesh_run.hpp"

namespace traceraft::bench {

inline constexpr double kTwoRaftsTolerance = 5e-4;  // of the integrator

struct TwoRaftsRequest {
  double epsilon;
  int cells;
  bool adaptive;
  int threads;
  double t_end;            // the smaller raft has to vanish before, in R²/D
  Point axis = {0, 0, 1};  // through both rafts
};

struct TwoRafts {
  double vanishes;  // the time at which one raft is left, in R²/D
  double seconds;   // of the whole computation
  simulation::RemeshStatistics meshes;

  double steps_per_remesh() const;  // the time of a remesh in steps
};

// Caps of 26 and 20 degrees opposite to each other, with the mobility c (1 − c), followed until the
// smaller one has vanished. Throws std::runtime_error where it has not by t_end.
TwoRafts follow_two_rafts(const Bench& bench, const TwoRaftsRequest& request);

}  // namespace traceraft::bench
