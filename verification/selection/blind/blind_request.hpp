// The request for a blind case: effects to be hidden in synthetic measurements, and how these are
// to be made.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/problem/cahn_hilliard.hpp"
#include "verification/selection/blind/noise_waves.hpp"

namespace traceraft::selection {

// Streams of random numbers: what is drawn for one purpose does not depend on how much is drawn for
// another. Those of points (two) and of noise count up by snapshots.
struct BlindRequest {
  problem::CahnHilliardModel base;   // on the unit sphere
  std::vector<std::string> effects;  // hidden; signs and mixtures are drawn
  double gap = 0.06;  // root mean square change of c that each makes from one snapshot to the next,
                      // in units of the standard deviation of c, in the first vesicle
  double diffusion_ratio = 1;  // D of the truth over that of the model
  double noise = 0.1;          // standard deviation, in units of that of c
  double noise_share = 0,      // share of the noise's variance that neighbours share
      noise_correlation = 0;   // the length over which they share it, in R
  NoiseShape noise_shape = NoiseShape::gaussian;  // how they share it
  double blur = 0;  // standard deviation of the microscope's point spread function, in R
  int vesicles = 1;
  int snapshots = 8;             // of each
  int sizing_snapshots = 0;      // that effects make the gap between; 0: so many as there are
  int points = 4000;             // per snapshot
  double first = 20, last = 90;  // times of snapshots, in units of R²/D of the model
  // The standard deviations that the data state for every second snapshot, over the true ones,
  // which they state for the others; 0: they state none.
  double stated = 0;
  double raft_fraction = 0.5;
  // The state that a vesicle starts from, as in --initial; "": band-limited noise, six widths of a
  // boundary long, which makes no rafts of raft fractions below 0.21.
  std::string initial;
  // Cells of the mesh that other noise is drawn on; 0: a quarter of `cells`.
  std::int64_t noise_cells = 0;
  int cells = 34;
  int sizing_cells = 0;  // of the mesh on which strengths are found, to a few percent; 0: 0.7 cells
  std::string integrator = "rosenbrock";
  double tolerance = 1e-4;
  std::uint64_t seed = 1;
  int threads = 2;
};

}  // namespace traceraft::selection
