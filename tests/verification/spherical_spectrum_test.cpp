#include "verification/bench/spherical_spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

// xyz is a harmonic of degree 3, z² − 1/3 one of degree 2, with ∫ (xyz)² = 4π/105 and
// ∫ (z² − 1/3)² = 16π/45.
TEST(SphericalSpectrum, SeparatesTheDegrees) {
  const auto space = testing::make_space(96);
  Vec c(space->nodes());
  for (int i = 0; i < space->nodes(); ++i) {
    const Point x = space->mesh.position(i).normalized();
    c[i] = 0.7 + 10 * x[0] * x[1] * x[2] + 2 * (x[2] * x[2] - 1.0 / 3);
  }
  const std::vector<double> spectrum = bench::spherical_spectrum(*space, c, 8);
  ASSERT_EQ(spectrum.size(), 9u);
  const std::vector<double> expected = {
      0.49 * 4 * kPi, 0, 4 * 16 * kPi / 45, 100 * 4 * kPi / 105, 0, 0, 0, 0, 0};
  // Linear functions on flat triangles have less of the curved parts than the harmonics.
  double total = 0;
  for (int l = 0; l <= 8; ++l) {
    EXPECT_NEAR(spectrum[l], expected[l], 1e-5 * expected[0] + 0.005 * expected[l]) << l;
    total += spectrum[l];
  }
  EXPECT_NEAR(total, space->inner(c, c), 3e-3 * total);
  EXPECT_NEAR(bench::median_degree(spectrum), 2.5 + 0.5 * (expected[3] - expected[2]) / expected[3],
              0.02);
}

// A zonal harmonic of high degree around a tilted axis: all orders m take part.
TEST(SphericalSpectrum, DoesNotDependOnTheAxis) {
  constexpr unsigned kDegree = 7;
  const auto space = testing::make_space(72);
  const Point axis = Point(1, 2, -2) / 3;
  Vec c(space->nodes());
  for (int i = 0; i < space->nodes(); ++i)
    c[i] = std::legendre(kDegree, axis.dot(space->mesh.position(i).normalized()));
  // Beyond 1/h = 22 there is no noise that adds up.
  const std::vector<double> spectrum = bench::spherical_spectrum(*space, c, 33);
  EXPECT_NEAR(spectrum[kDegree], space->inner(c, c), 5e-3 * spectrum[kDegree]);
  EXPECT_NEAR(spectrum[kDegree], 4 * kPi / 15, 0.02 * 4 * kPi / 15);
  EXPECT_NEAR(bench::median_degree(spectrum), kDegree, 0.05);
}

}  // namespace
}  // namespace traceraft
