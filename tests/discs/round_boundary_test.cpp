#include "kernel/discs/round_boundary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/types.hpp"

namespace traceraft::discs {
namespace {

double outer_phase(double nu) {
  double c = nu;
  for (int k = 0; k < 50; ++k) c -= (c * (1 - c) * (1 - 2 * c) - nu) / (1 - 6 * c + 6 * c * c);
  return c;
}

struct Raft {
  double nu, mass, energy;  // beyond the phase outside
};

Raft raft_of(double radius) {
  const RoundBoundary at = round_boundary(radius).value;
  const double nu = at.potential / (6 * radius), outside = outer_phase(nu),
               inside = 1 - outer_phase(-nu), area = kPi * radius * radius;
  const auto well = [](double c) { return 0.5 * c * c * (1 - c) * (1 - c); };
  return {nu, at.held_mass + area * (inside - outside),
          at.energy * 2 * kPi * radius / 6 + area * (well(inside) - well(outside))};
}

// Among rafts in local equilibrium the energy changes by μ times what they hold.
TEST(RoundBoundaryTest, EnergyAndMassChangeTogetherAsThePotentialSays) {
  for (const double radius : {2.0, 3.1, 4.6, 8.2, 14.0}) {
    const double step = 0.25;
    const Raft smaller = raft_of(radius - step), larger = raft_of(radius + step),
               here = raft_of(radius);
    EXPECT_NEAR((larger.energy - smaller.energy) / (larger.mass - smaller.mass), here.nu,
                1e-2 * here.nu)
        << radius;
  }
}

TEST(RoundBoundaryTest, IsASharpOneWhereItIsWide) {
  for (const double radius : {18.0, 40.0, 1e3, 1e300}) {
    const RoundBoundary at = round_boundary(radius).value;
    EXPECT_NEAR(at.potential, 1, 0.3 / (radius * radius));
    EXPECT_NEAR(at.energy, 1, 0.3 / (radius * radius));
    EXPECT_NEAR(at.gradients, 1, 3 / (radius * radius));
  }
}

TEST(RoundBoundaryTest, HasTheSlopesOfItsValues) {
  for (const double radius : {1.7, 3.3, 9.9, 19.8, 25.0}) {
    const double step = 1e-5;
    const RoundBoundary low = round_boundary(radius - step).value,
                        high = round_boundary(radius + step).value,
                        slope = round_boundary(radius).slope;
    for (auto member : {&RoundBoundary::potential, &RoundBoundary::held_mass,
                        &RoundBoundary::energy, &RoundBoundary::gradients})
      EXPECT_NEAR(slope.*member, (high.*member - low.*member) / (2 * step), 1e-6) << radius;
  }
}

}  // namespace
}  // namespace traceraft::discs
