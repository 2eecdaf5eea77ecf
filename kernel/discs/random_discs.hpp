// Discs at random places, to begin with.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/discs/disc.hpp"
#include "kernel/physics/double_well.hpp"

namespace traceraft::discs {

struct RandomDiscs {
  int number = 100;
  double spread = 0.3;          // standard deviation of the logarithm of their areas
  double raft_fraction = 0.16;  // the mean of c, with nothing outside the discs
  physics::DoubleWell well;     // at 0 and 1
  double epsilon = 0.05;
  std::uint64_t seed = 1;
};

// The largest first. Throws InputError if they do not fit.
std::vector<Disc> random_discs(const RandomDiscs& request);

}  // namespace traceraft::discs
