#include "verification/selection/search/bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace traceraft::selection {
namespace {

Bound bound_of(const std::string& effect, const std::vector<double>& coefficients,
               const Eigen::MatrixXd& covariance, double null_mean) {
  Screening screening;
  screening.scores = {{effect, coefficients, 0, null_mean, 1, 0, covariance, 1}};
  const std::vector<Bound> bounds =
      bounds_of(screening, {assimilation::find_candidate(effect).value()});
  return bounds.at(0);
}

Eigen::MatrixXd variance(double sigma) {
  return Eigen::MatrixXd::Constant(1, 1, sigma * sigma);
}

TEST(Bounds, AreTwoSidedWhereSignsAreFree) {
  const Bound bound = bound_of("gravity", {0.3}, variance(0.1), 1);
  EXPECT_NEAR(bound.low, 0.3 - 0.196, 1e-9);
  EXPECT_NEAR(bound.high, 0.3 + 0.196, 1e-9);
  EXPECT_TRUE(bound.seen);
}

TEST(Bounds, StartAtZeroWhereSignsAreFixed) {
  const Bound bound = bound_of("bulk-mobility", {0.0}, variance(0.1), 0.5);
  EXPECT_EQ(bound.low, 0);
  EXPECT_NEAR(bound.high, 0.1645, 1e-9);
}

// The rate of exchange is the sum of its two coefficients.
TEST(Bounds, AreThoseOfTheFirstParameter) {
  Eigen::Matrix2d covariance;
  covariance << 0.04, -0.03, -0.03, 0.05;
  const Bound bound = bound_of("exchange", {0.1, 0.2}, covariance, 1);
  EXPECT_NEAR(bound.high, 0.3 + 1.645 * std::sqrt(0.03), 1e-6);
}

TEST(Bounds, WidenWhereNoiseGainsMoreThanItShould) {
  EXPECT_NEAR(bound_of("gravity", {0.0}, variance(0.1), 4).high, 0.392, 1e-9);
  EXPECT_NEAR(bound_of("gravity", {0.0}, variance(0.1), 0.7).high, 0.196, 1e-9);
}

TEST(Bounds, AreNoneOfWhatIsNotSeen) {
  EXPECT_FALSE(bound_of("gravity", {0.0}, variance(0), 1).seen);
}

}  // namespace
}  // namespace traceraft::selection
