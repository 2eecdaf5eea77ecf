// Synthetic measurements with a hidden effect, or none, from a simulation that shares neither mesh
// nor resolution nor integrator with the analysis.
#pragma once

#include <cstdint>
#include <optional>

#include "verification/bench.hpp"
#include "verification/explain/candidates.hpp"
#include "verification/explain/field_series.hpp"

namespace traceraft {

struct BlindRequest {
  CahnHilliardModel base;  // on the unit sphere
  std::string effect;      // "": nothing hidden
  double gap = 0.06;   // root mean square change of c that the effect makes from one snapshot to
                       // the next, in units of the standard deviation of c
  double pace = 1;     // D of the truth over that of the model
  double noise = 0.1;  // standard deviation, in units of that of c
  int snapshots = 8;
  int points = 4000;            // per snapshot
  double first = 2, last = 20;  // times of snapshots, in units of R²/D of the model
  double raft_fraction = 0.5;
  int cells = 48;
  std::string integrator = "rosenbrock";
  double tolerance = 1e-4;
  std::uint64_t seed = 1;
  int threads = 2;
};

struct BlindCase {
  FieldSeries series;
  std::vector<EffectTerm> truth;  // in units of R and R²/D of the truth
  double noise;                   // standard deviation of the values
  double gap;                     // that was reached
};

// Throws std::runtime_error if a simulation fails.
BlindCase draw_blind_case(const BlindRequest& request);

}  // namespace traceraft
