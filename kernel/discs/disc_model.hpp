// The physics of a vesicle whose rafts are discs.
#pragma once

#include <cstdint>

#include "kernel/flow/fluid_membrane.hpp"
#include "kernel/physics/double_well.hpp"
#include "kernel/physics/mobility.hpp"

namespace traceraft::discs {

// Lengths are in R and times in R²/D. The wells are at 0 and 1.
struct DiscModel {
  physics::MobilityPtr mobility;
  physics::DoubleWell well;
  double epsilon = 0.05;  // width of a boundary: it gives the line tension
  // Its `thermal` is the strength of Brownian motion; 0: there is none. Line tension is taken to
  // make discs round at once.
  flow::FluidMembrane membrane;
  double uptake = 0;  // s of ċ = … + s (1 − c): raft lipids that come in outside rafts
  std::uint64_t seed = 1;
};

}  // namespace traceraft::discs
