#include "kernel/time/step_control.hpp"

#include <gtest/gtest.h>

namespace traceraft::time {
namespace {

StepControl control_of(double min_step, double span) {
  IntegratorSettings settings;
  settings.min_step = min_step;
  return StepControl(settings, span, 2);
}

// Steps over [0, 1] that only succeed up to a size.
struct Attempts {
  double largest_good;
  std::vector<double> tried = {};
  Status operator()(double dt, double& error) {
    tried.push_back(dt);
    error = 0;
    if (tried.size() > 1000) return Status::fatal("endless");
    return dt <= largest_good ? Status{} : Status::retry("too long");
  }
};

Status take(const StepControl& control, double t, double dt, Attempts& attempts) {
  IntegratorStatistics statistics;
  return take_step(
      control, t, 1.0, dt, statistics, [&](double h, double& e) { return attempts(h, e); },
      [](double, double, double) {});
}

TEST(StepControl, TriesTheSmallestStepOnceAndGivesUp) {
  Attempts attempts{0};
  const Status status = take(control_of(1e-3, 1), 0.2, 0.1, attempts);
  EXPECT_EQ(status.outcome, Outcome::fatal);
  EXPECT_NE(status.why.find("no step size: too long"), std::string::npos);
  EXPECT_EQ(attempts.tried.back(), 1e-3);
  EXPECT_EQ(std::count(attempts.tried.begin(), attempts.tried.end(), 1e-3), 1);
}

TEST(StepControl, TakesTheSmallestStepIfThatWorks) {
  Attempts attempts{1e-3};
  EXPECT_TRUE(take(control_of(1e-3, 1), 0.2, 0.1, attempts).ok());
}

// The rest of the run is longer than the smallest step, but not by enough for another.
TEST(StepControl, GivesUpNearTheEndToo) {
  const double left = 1.5e-14;
  Attempts attempts{0};
  const Status status = take(control_of(0, 1), 1 - left, left, attempts);
  EXPECT_NE(status.why.find("no step size"), std::string::npos) << status.why;
  EXPECT_LT(attempts.tried.size(), 5u);
}

}  // namespace
}  // namespace traceraft::time
