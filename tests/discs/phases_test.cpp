#include "kernel/discs/phases.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/discs/disc.hpp"

namespace traceraft::discs {
namespace {

DiscModel phase_model(const char* mobility = "degenerate", double epsilon = 0.02) {
  DiscModel result;
  result.mobility = physics::make_mobility(mobility);
  result.epsilon = epsilon;
  return result;
}

TEST(PhasesTest, BothPhasesHaveThePotentialOfTheBoundary) {
  const DiscModel physics = phase_model();
  const Phases phases(physics);
  for (const double area : {0.02, 0.1, 1.0, 5.0, 2 * kPi}) {
    const double mu = phases.potential(area);
    EXPECT_NEAR(physics.well.derivative(phases.outside(mu)), mu, 1e-14);
    EXPECT_NEAR(physics.well.derivative(phases.inside(mu)), mu, 1e-14);
    EXPECT_LT(phases.outside(mu), 0.2114);
    EXPECT_GT(phases.inside(mu), 1 - 1e-14);
  }
  EXPECT_NEAR(phases.potential(2 * kPi), 0, 1e-16);  // a great circle is straight
  // ε/(6√2) of the default well.
  EXPECT_NEAR(phases.potential(area_of_half_angle(kPi / 4)) * 6 * std::sqrt(2.0) / 0.02, 1, 3e-4);
}

// ∫ c (1 − c) ½ (1 − 6c + 6c²) dc; below 0 the degenerate law has the other sign.
TEST(PhasesTest, TheFluxPotentialIsTheIntegralOfMobilityAndCurvatureOfTheWell) {
  const auto exact = [](double c) {
    return (c < 0 ? -0.5 : 0.5) *
           (c * c / 2 - 7 * c * c * c / 3 + 3 * c * c * c * c - 6 * std::pow(c, 5) / 5);
  };
  const Phases degenerate(phase_model()), constant(phase_model("constant:value=0.25"));
  for (const double c : {-0.2, -0.01, -1e-4, 0.0, 1e-4, 0.003, 0.05, 0.13, 0.2}) {
    EXPECT_NEAR(degenerate.flux_potential(c), exact(c), 1e-9 * std::fabs(c)) << c;
    EXPECT_NEAR(constant.flux_potential(c), 0.25 * physics::DoubleWell{}.derivative(c), 1e-9) << c;
  }
}

TEST(PhasesTest, ADiscAndItsMassAreOneToOne) {
  const Phases phases(phase_model());
  for (const double area : {0.03, 0.2, 3.0}) {
    const double step = 1e-6 * area;
    EXPECT_NEAR(phases.mass_slope(area),
                (phases.mass(area + step) - phases.mass(area - step)) / (2 * step), 1e-7);
    EXPECT_NEAR(phases.area_of_mass(phases.mass(area)), area, 1e-12);
  }
}

// In the plane, where the integral is 2π ∫ r c dr.
TEST(PhasesTest, ADiffuseBoundaryHoldsWhatTheIntegralOfItsProfileSays) {
  const physics::DoubleWell well;
  const double epsilon = 0.02, radius = 0.6, step = 1e-4;
  double sum = 0;
  for (double r = step / 2; r < 1.2; r += step)
    sum += 2 * kPi * r * well.profile(r - radius, epsilon) * step;
  EXPECT_NEAR(sum - kPi * radius * radius, boundary_mass(well, epsilon), 1e-6);
}

TEST(PhasesTest, TwoBoundariesInContactHaveTheSpinodalBetweenThem) {
  const physics::DoubleWell well;
  const double half = contact_distance(well, 0.02) / 2;
  EXPECT_NEAR(well.second(2 * well.profile(half, 0.02)), 0, 1e-12);
}

// Against the resistance of the tail, integrated: ∫ ds (1/m − 1/(m + e^(−s/δ))) = tail/m.
TEST(PhasesTest, TheTailOfAProfileHasTheResistanceOfItsLengthLess) {
  const Phases phases(phase_model());
  const double mu = phases.potential(0.2), length = 0.02 * std::sqrt(2.0);
  const double c = phases.outside(mu), m = c * (1 - c), step = 1e-5;
  double less = 0;
  for (double s = step / 2; s < 40 * length; s += step)
    less += step * (1 - m / (m + std::exp(-s / length)));
  EXPECT_NEAR(phases.tail(phases.outside(mu)), less, 1e-6);
}

}  // namespace
}  // namespace traceraft::discs
