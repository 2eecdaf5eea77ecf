#include "verification/analytic/sphere_boundary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/types.hpp"

namespace traceraft {
namespace {

// ε² (c'' − tan φ c') = f0'(c), by differences over a distance that the solution does not know.
TEST(SphereBoundary, SolvesItsEquation) {
  const physics::DoubleWell well;
  for (const double epsilon : {0.05, 0.3}) {
    const analytic::SphereBoundary boundary(well, epsilon);
    const double d = 0.05 * epsilon;
    for (double latitude = -1.2; latitude <= 1.2; latitude += 0.1) {
      const double south = boundary.profile(latitude - d), here = boundary.profile(latitude),
                   north = boundary.profile(latitude + d);
      const double second = (north - 2 * here + south) / (d * d), first = (north - south) / (2 * d);
      EXPECT_NEAR(epsilon * epsilon * (second - std::tan(latitude) * first), well.derivative(here),
                  1e-4)
          << epsilon << " " << latitude;
    }
    EXPECT_DOUBLE_EQ(boundary.profile(0), 0.5);
  }
}

// The first correction to the energy of a flat boundary, from ∫ |∇c|² cos φ of the tanh profile.
TEST(SphereBoundary, ApproachesAFlatBoundary) {
  const physics::DoubleWell well;
  for (const double epsilon : {0.02, 0.04}) {
    const analytic::SphereBoundary boundary(well, epsilon);
    const double flat = 2 * kPi * epsilon * well.interface_energy();
    const double correction = 4 * epsilon * epsilon * (kPi * kPi / 12 - 0.5);
    EXPECT_NEAR(boundary.energy() / flat, 1 - correction, 0.03 * correction);
    EXPECT_NEAR(boundary.width() / (2 * kPi * std::sqrt(2.0) * epsilon), 1, 20 * epsilon * epsilon);
  }
}

}  // namespace
}  // namespace traceraft
