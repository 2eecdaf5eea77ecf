// What refits say in the units of their user.
#include "drivers/explain/found_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "verification/explain/candidates.hpp"

namespace traceraft {
namespace {

// R = 5 µm and D = 1e-5 cm²/s, R²/D is 0.025 s.
const Units kCell{5, 1e-5};

Refit exchange(double a0, double a1) {
  Refit fit;
  fit.hypothesis.parts = {{find_candidate("exchange").value(), {a0, a1}}};
  fit.covariance = Vec(Eigen::Vector2d(9e-4, 1e-6)).asDiagonal();
  return fit;
}

TEST(FoundParameters, ErrorsAreThoseOfWhatTheyAreMadeOf) {
  const auto found = found_parameters(exchange(0.03, 0.01), kCell);
  EXPECT_NEAR(found[0].value, 0.04 / 0.025, 1e-9);
  EXPECT_NEAR(found[0].sigma.value(), std::sqrt(9e-4 + 1e-6) / 0.025, 1e-4);
  // c* = a1 / (a0 + a1).
  EXPECT_NEAR(found[1].value, 0.25, 1e-12);
  EXPECT_NEAR(found[1].sigma.value(), std::hypot(0.01 * 0.03, 0.03 * 0.001) / 0.0016, 1e-3);
}

// With one coefficient held at zero, the exchange is an uptake, and as certain.
TEST(FoundParameters, WhatIsHeldDoesNotBlurTheRate) {
  const auto found = found_parameters(exchange(0, 0.01), kCell);
  EXPECT_NEAR(found[0].sigma.value(), 1e-3 / 0.025, 1e-4);
  EXPECT_EQ(found[1].value, 1);
  EXPECT_GT(found[1].sigma.value(), 1);  // of a target nothing is known
}

}  // namespace
}  // namespace traceraft
