#include "kernel/discs/brownian_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/random.hpp"
#include "tests/support/harmonics.hpp"

namespace traceraft::discs {
namespace {

using testing::exact_harmonic;

constexpr flow::FluidMembrane kMembrane{0, 1.25, 1e-3};

Disc disc(const Point& direction, double angle) {
  return {direction.normalized(), area_of_half_angle(angle)};
}

// The weight of a disc in degree l, by the associated Legendre function of order 1.
double weight(int l, double angle) {
  const double p = std::assoc_legendre(static_cast<unsigned>(l), 1U, std::cos(angle));
  return 2 * p / (std::sin(angle) * l * (l + 1));
}

TEST(BrownianMotionTest, ADiscMovesAsTheSumOverAllWavesSays) {
  for (const double angle : {0.1, 0.5, 1.2}) {
    const BrownianMotion motion(kMembrane);
    double exact = 0;  // the variance of one direction
    for (int l = 1; l <= 400; ++l)
      exact += 2 * kMembrane.thermal * std::pow(weight(l, angle), 2) * l * (l + 1) * (2 * l + 1) /
               (8 * kPi * kMembrane.friction(l));
    EXPECT_NEAR(motion.largest_variance({disc({1, 2, 3}, angle)}), exact, 4e-3 * exact) << angle;
  }
}

TEST(BrownianMotionTest, TheSmallestDiscMovesFastest) {
  const BrownianMotion motion(kMembrane);
  const Disc small = disc({1, 0, 0}, 0.15), middle = disc({0, 0, 1}, 0.3);
  const double fastest = motion.largest_variance({small});
  EXPECT_GT(fastest, 1.2 * motion.largest_variance({middle}));
  for (const double angle : {0.4, 1.5, 2.9})
    EXPECT_DOUBLE_EQ(motion.largest_variance({middle, small, disc({-1, 0, 0}, angle)}), fastest)
        << angle;
}

// Covariances from the derivatives of all harmonics at both places.
TEST(BrownianMotionTest, TwoDiscsMoveTogetherAsTheHarmonicsDo) {
  const std::vector<Disc> discs = {disc({1, 0.2, 0.3}, 0.25), disc({0.8, 0.7, -0.1}, 0.3)};
  BrownianMotion motion(kMembrane);
  motion.set_discs(discs);
  const Point axis = discs[0].centre.cross(discs[1].centre).normalized();
  const double step = 1e-4;
  // The velocity n × ∇ψ along the line between both is minus the derivative of ψ across it.
  const auto along = [&](const Point& x, int l, int m) {
    return (exact_harmonic(l, m, x - step * axis) - exact_harmonic(l, m, x + step * axis)) /
           (2 * step);
  };
  double variance = 0;
  for (int l = 1; l <= 20; ++l)
    for (int m = -l; m <= l; ++m) {
      const double difference = weight(l, 0.25) * along(discs[0].centre, l, m) -
                                weight(l, 0.3) * along(discs[1].centre, l, m);
      variance += 2 * kMembrane.thermal / kMembrane.friction(l) * difference * difference;
    }
  EXPECT_NEAR(motion.variance_of_distance(0, 1), variance, 5e-3 * variance);
}

TEST(BrownianMotionTest, DisplacementsHaveTheVarianceThatIsSaid) {
  BrownianMotion motion(kMembrane);
  const std::vector<Disc> discs = {disc({1, 0, 0}, 0.2), disc({0.8, 0.6, 0}, 0.3),
                                   disc({0, 0.1, 1}, 0.25)};
  motion.set_discs(discs);
  const double step = 0.7;
  const int draws = 20000;
  double own = 0, distance = 0;
  for (int k = 0; k < draws; ++k) {
    Vec normal(6);
    for (int i = 0; i < 6; ++i)
      normal[i] = normal_random(5, static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(i));
    const std::vector<Point> moved = motion.displacements(step, normal);
    ASSERT_EQ(moved.size(), 3U);
    EXPECT_NEAR(moved[2].dot(discs[2].centre), 0, 1e-15);
    own += moved[0].squaredNorm() / 2;
    const Point axis = discs[0].centre.cross(discs[1].centre).normalized();
    const double change =
        moved[1].dot(axis.cross(discs[1].centre)) - moved[0].dot(axis.cross(discs[0].centre));
    distance += change * change;
  }
  const double error = 4 * std::sqrt(2.0 / draws);
  const double said = motion.variance_of_distance(0, 1) * step;
  EXPECT_NEAR(distance / draws, said, error * said);
  const double alone_said = motion.largest_variance({discs[0]}) * step;
  EXPECT_NEAR(own / draws, alone_said, error * alone_said);
}

// Stokes's law for a rotation: kT/(8π η_w R³), in units of D/R².
TEST(BrownianMotionTest, AWholeSphereRotatesAsWaterLetsIt) {
  flow::FluidMembrane stiff{0, 1e6, 1};
  const double largest = BrownianMotion(stiff).largest_variance({disc({0, 0, 1}, 1.5)});
  // The rotation, l = 1, moves a hemisphere more than any other wave: F_1 = 1.
  const double rotation = 2 * stiff.thermal * 3 * 2 / (8 * kPi * stiff.friction(1));
  EXPECT_NEAR(rotation, 2 / (8 * kPi * stiff.water), 1e-6 * rotation);
  EXPECT_GT(largest, rotation);
  EXPECT_LT(largest, 1.3 * rotation);
}

}  // namespace
}  // namespace traceraft::discs
