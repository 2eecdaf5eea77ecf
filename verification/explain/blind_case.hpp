// Synthetic measurements with a hidden effect, or none, from a simulation that shares neither mesh
// nor resolution nor integrator with the analysis.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verification/bench.hpp"
#include "verification/explain/candidates.hpp"
#include "verification/explain/field_series.hpp"

namespace traceraft {

struct BlindRequest {
  CahnHilliardModel base;            // on the unit sphere
  std::vector<std::string> effects;  // hidden; signs and mixtures are drawn
  double gap = 0.06;  // root mean square change of c that each makes from one snapshot to the next,
                      // in units of the standard deviation of c, in the first vesicle
  double pace = 1;    // D of the truth over that of the model
  double noise = 0.1;  // standard deviation, in units of that of c
  int vesicles = 1;
  int snapshots = 8;             // of each
  int points = 4000;             // per snapshot
  double first = 20, last = 90;  // times of snapshots, in units of R²/D of the model
  // The standard deviations that the data state for every second snapshot, over the true ones,
  // which they state for the others; 0: they state none.
  double stated = 0;
  double raft_fraction = 0.5;
  // What a vesicle starts from, as in --initial; "": band-limited noise, six widths of a boundary
  // long, which makes no rafts of raft fractions below 0.21.
  std::string initial;
  // Of the mesh that other noise is drawn on; 0: a quarter of `cells`.
  std::int64_t noise_cells = 0;
  int cells = 34;
  std::string integrator = "rosenbrock";
  double tolerance = 1e-4;
  std::uint64_t seed = 1;
  int threads = 2;
};

struct BlindCase {
  std::vector<FieldSeries> vesicles;
  std::vector<EffectTerm> truth;  // in units of R and R²/D of the truth
  double noise;                   // standard deviation of the values
};

// Effects that can be hidden: those that a sphere shows.
std::vector<std::string> effects_to_hide();

// The request's effects with the strengths at which they make its gap. Throws as below.
std::vector<EffectTerm> size_effects(const BlindRequest& request);

// Throws std::runtime_error if a simulation fails, InputError for an effect that cannot be hidden.
BlindCase draw_blind_case(const BlindRequest& request);

}  // namespace traceraft
