#include "backends/nlopt/minimise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace traceraft {
namespace {

TEST(Minimise, FindsTheMinimumOfRosenbrocksValley) {
  const auto valley = [](const std::vector<double>& x) {
    return 100 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1 - x[0], 2);
  };
  const nlopt::Minimum found =
      nlopt::minimise({valley, {-1.2, 1}, {-5, -5}, {5, 5}, {0.5, 0.5}, 1e-7, 20000});
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0], 1, 1e-3);
  EXPECT_NEAR(found.x[1], 1, 1e-3);
}

TEST(Minimise, StaysWithinBoundsAndBudget) {
  const auto slope = [](const std::vector<double>& x) { return x[0]; };
  EXPECT_NEAR(nlopt::minimise({slope, {0.5}, {0.25}, {1}, {0.1}}).x[0], 0.25, 1e-6);
  const nlopt::Minimum cut = nlopt::minimise({slope, {0.5}, {-1e6}, {1}, {0.1}, 1e-12, 5});
  EXPECT_FALSE(cut.converged);
  EXPECT_LE(cut.evaluations, 6);
}

TEST(Minimise, PassesExceptionsOn) {
  const auto fails = [](const std::vector<double>&) -> double { throw std::domain_error("no"); };
  EXPECT_THROW((void)nlopt::minimise({fails, {0}, {-1}, {1}, {0.1}}), std::domain_error);
}

}  // namespace
}  // namespace traceraft
