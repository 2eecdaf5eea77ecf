#include "verification/observations/history.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "verification/statistics/sample.hpp"

namespace traceraft::observations {
namespace {

History history(std::vector<double> time, std::vector<double> values) {
  return {std::move(time), {values, values, values}};
}

TEST(History, InterpolatesLengthsAndKeepsCounts) {
  const History h = history({0, 1, 3}, {4, 2, 1});
  EXPECT_DOUBLE_EQ(h.at(Quantity::perimeter, 2), 1.5);
  EXPECT_DOUBLE_EQ(h.at(Quantity::fraction, 0.25), 3.5);
  EXPECT_DOUBLE_EQ(h.at(Quantity::rafts, 2.9), 2);
  EXPECT_DOUBLE_EQ(h.at(Quantity::rafts, 3), 1);
  for (const Quantity quantity : kQuantities) {
    EXPECT_DOUBLE_EQ(h.at(quantity, -1), 4);
    EXPECT_DOUBLE_EQ(h.at(quantity, 9), 1);
  }
}

TEST(History, CommonTimesAreWhatAllCover) {
  const std::vector<double> times =
      common_times({history({0, 0.1, 100}, {1, 1, 1}), history({0, 1, 10, 1000}, {1, 1, 1, 1})}, 2);
  ASSERT_EQ(times.size(), 5u);
  EXPECT_DOUBLE_EQ(times.front(), 1);
  EXPECT_DOUBLE_EQ(times.back(), 100);
  EXPECT_NEAR(times[1], std::sqrt(10), 1e-12);
  EXPECT_TRUE(common_times({history({0, 1}, {1, 1}), history({0, 2, 3}, {1, 1, 1})}, 2).empty());
  EXPECT_TRUE(common_times({}, 2).empty());
}

}  // namespace
}  // namespace traceraft::observations
