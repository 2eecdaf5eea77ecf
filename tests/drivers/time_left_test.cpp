#include "drivers/output/time_left.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace traceraft {
namespace {

TEST(TimeLeft, IsThatOfStepsThatGrowWithTime) {
  TimeLeft left(1e4);
  for (int k = 0; k <= 50; ++k) left.note(std::pow(10, 0.04 * k), k);
  EXPECT_NEAR(left.seconds(), 50, 1e-6);
  EXPECT_NEAR(left.share(), 0.5, 1e-6);
}

// Ten steps before the end there is little time for them to grow.
TEST(TimeLeft, IsNearlyThatOfStepsOfOneLengthAtTheEnd) {
  TimeLeft left(100);
  for (int k = 0; k <= 90; ++k) left.note(k, 2.0 * k);
  EXPECT_NEAR(left.seconds(), 20, 5);
  EXPECT_LE(left.seconds(), 20);
}

// A hundred steps, then ten short ones while a raft vanishes.
TEST(TimeLeft, IsNotWhatAFewShortStepsSay) {
  TimeLeft left(1000);
  double seconds = 0, before = 0;
  for (int k = 0; k < 110; ++k) {
    before = left.share();
    left.note(k < 100 ? k + 1 : 100 + 1e-3 * (k - 99), seconds += 1);
    EXPECT_GE(left.share(), before);
  }
  EXPECT_LT(left.seconds(), 1500);
  EXPECT_GT(left.seconds(), 100);
  left.note(1000, seconds + 1);
  EXPECT_EQ(left.share(), 1);
  EXPECT_EQ(left.seconds(), 0);
}

// An integrator that begins with a tiny step would be at the end soon if it went on so.
TEST(TimeLeft, IsUnknownWhileAnIntegratorFeelsItsWay) {
  TimeLeft left(200);
  for (int k = 0; k <= 40; ++k) left.note(1e-12 * std::pow(1.7, k), k);
  EXPECT_EQ(left.seconds(), 0);
  EXPECT_EQ(left.share(), 0);
}

TEST(TimeLeft, IsUnknownAtFirst) {
  TimeLeft left(10);
  left.note(0, 0);
  EXPECT_EQ(left.seconds(), 0);
  EXPECT_EQ(left.share(), 0);
}

}  // namespace
}  // namespace traceraft
