#include "backends/sundials/newton_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace traceraft {
namespace {

using Verdict = sundials::NewtonTest::Verdict;
constexpr double kBound = 0.1;

// A step whose first correction is `first` and whose second is `second`.
void measure(sundials::NewtonTest& test, double first, double second) {
  ASSERT_EQ(test.judge(0, first, kBound), Verdict::go_on);
  (void)test.judge(1, second, kBound);
}

TEST(NewtonTest, WithoutExperienceAsksForASecondCorrection) {
  sundials::NewtonTest test;
  EXPECT_EQ(test.judge(0, 2 * kBound, kBound), Verdict::go_on);
  EXPECT_EQ(test.judge(0, 0.9 * kBound, kBound), Verdict::converged);  // small enough as it is
}

TEST(NewtonTest, TrustsWhatItMeasuredForEightSteps) {
  sundials::NewtonTest test;
  measure(test, 1.0, 0.01);  // a hundredth is left of each correction
  for (int step = 0; step < 8; ++step)
    EXPECT_EQ(test.judge(0, 1.0, kBound), Verdict::converged) << step;
  EXPECT_EQ(test.judge(0, 1.0, kBound), Verdict::go_on);
}

TEST(NewtonTest, ExpectsMoreOfLargerCorrections) {
  sundials::NewtonTest test;
  measure(test, 1.0, 0.01);
  // Quadratic convergence: what is left grows with the square, 2 * 0.01 * 3 * 3 > 0.1.
  EXPECT_EQ(test.judge(0, 3.0, kBound), Verdict::go_on);
  sundials::NewtonTest slow;
  measure(slow, 1.0, 0.2);  // more is left than the bound
  EXPECT_EQ(slow.judge(0, 1.0, kBound), Verdict::go_on);
}

TEST(NewtonTest, JudgesLaterCorrectionsByTheirRate) {
  sundials::NewtonTest test;
  EXPECT_EQ(test.judge(0, 1.0, kBound), Verdict::go_on);
  EXPECT_EQ(test.judge(1, 0.5, kBound), Verdict::go_on);  // 0.5/(1 − 0.5) · 0.5 is left
  EXPECT_EQ(test.judge(2, 0.01, kBound), Verdict::converged);
  EXPECT_EQ(test.judge(0, 1.0, kBound), Verdict::go_on);
  EXPECT_EQ(test.judge(1, 0.95, kBound), Verdict::diverges);
  EXPECT_EQ(test.judge(0, std::nan(""), kBound), Verdict::diverges);
}

TEST(NewtonTest, RemembersItsExperienceOverARestart) {
  sundials::NewtonTest test;
  measure(test, 1.0, 0.01);
  std::stringstream saved;
  test.save(static_cast<std::ostream&>(saved));
  sundials::NewtonTest resumed;
  resumed.load(static_cast<std::istream&>(saved));
  EXPECT_EQ(resumed.judge(0, 1.0, kBound), Verdict::converged);
}

}  // namespace
}  // namespace traceraft
