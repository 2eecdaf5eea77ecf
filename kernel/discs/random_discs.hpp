// Discs to begin with, at random places.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/discs/disc.hpp"
#include "kernel/physics/double_well.hpp"

namespace traceraft::discs {

struct RandomDiscs {
  int number = 100;
  double spread = 0.3;          // standard deviation of the logarithm of their areas
  double raft_fraction = 0.16;  // the mean of c
  physics::DoubleWell well;     // at 0 and 1
  double epsilon = 0.05;
  std::uint64_t seed = 1;
};

// Discs with the profiles of straight boundaries, from 1 within to the background outside.
struct StartingDiscs {
  std::vector<Disc> discs;  // the largest first
  double background = 0;
};

// The background is in equilibrium with a disc of the mean area: it would take up lipids of all of
// them otherwise, for longer than many of them live. Throws InputError if discs do not fit.
StartingDiscs random_discs(const RandomDiscs& request);

}  // namespace traceraft::discs
