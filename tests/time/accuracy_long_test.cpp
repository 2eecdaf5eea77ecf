// Are the solutions of the integrators, at and between their steps, as accurate as they say?
#include <gtest/gtest.h>

#include <algorithm>

#include "backends/list.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::time {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;

class Accuracy : public ::testing::TestWithParam<std::string> {
 protected:
  Accuracy() : space(make_space(10)), problem(space, make_model("degenerate", 0.3)) {}

  IntegratorPtr make(const std::string& name, const IntegratorSettings& settings) const {
    return backends::integrators().find(name).make(
        problem, backends::choose_linear_solver("direct", *space), space->team, settings);
  }
  static IntegratorSettings tight() {
    IntegratorSettings settings;
    settings.tolerance = 1e-8;
    settings.linear_tolerance = 1e-10;
    return settings;
  }
  // The solution at t1 that starts from c in y at t0.
  Vec solution(double t0, const Vec& y, double t1) const {
    Vec start = y, rate = Vec::Zero(y.size());
    EXPECT_TRUE(problem.consistent_initial_state(t0, start, rate).ok());
    const IntegratorPtr exact = make("rosenbrock", tight());
    EXPECT_TRUE(exact->start(t0, start, rate, t1).ok());
    while (exact->time() < t1) EXPECT_TRUE(exact->advance().ok());
    return exact->state();
  }

  std::shared_ptr<const fem::SurfaceSpace> space;
  problem::CahnHilliard problem;
};

// The error of each step alone stays below the tolerance, but not by much: the estimates are of the
// lower order of a pair, and the steps aim below the tolerance. Measured: at most 0.1 to 0.2 of it.
TEST_P(Accuracy, TheToleranceBoundsTheErrorOfAStep) {
  IntegratorSettings settings;
  settings.tolerance = 1e-3;
  settings.linear_tolerance = 1e-6;
  const IntegratorPtr integrator = make(GetParam(), settings);
  const auto start = noise_state(problem, 2, 0.4);
  ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 100).ok());
  double largest = 0;
  for (int step = 0; step < 45 && integrator->time() < 100; ++step) {
    const Vec before = integrator->state();
    const double t = integrator->time();
    const Status status = integrator->advance();
    ASSERT_TRUE(status.ok()) << "step " << step << ", t = " << t << ": " << status.why;
    if (step < 15) continue;  // multistep methods still gather their past
    const Vec exact = solution(t, before, integrator->time());
    const double error =
        problem.norm(integrator->state() - exact) / problem.norm(exact) / settings.tolerance;
    EXPECT_LT(error, 0.6) << "step " << step;
    largest = std::max(largest, error);
  }
  EXPECT_GT(largest, 0.05);
}

// Between the steps the solution is about as good as at their ends, which straight lines are not.
TEST_P(Accuracy, InterpolationKeepsTheOrder) {
  IntegratorSettings settings;
  settings.tolerance = 1e-5;
  settings.linear_tolerance = 1e-8;
  const IntegratorPtr integrator = make(GetParam(), settings);
  const auto start = noise_state(problem, 2, 0.4);
  ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 100).ok());
  const IntegratorPtr exact = make("rosenbrock", tight());
  ASSERT_TRUE(exact->start(0, start.y, start.ydot, 100).ok());
  const auto exact_at = [&](double t, Vec& y) {
    while (exact->time() < t) ASSERT_TRUE(exact->advance().ok());
    ASSERT_TRUE(exact->interpolate(t, y).ok());
  };
  double between = 0, at_ends = 0, straight = 0;
  Vec y(problem.size()), reference(problem.size());
  while (integrator->time() < 2) {
    const Vec before = integrator->state();
    ASSERT_TRUE(integrator->advance().ok());
    const double t1 = integrator->time(), dt = integrator->step();
    if (integrator->statistics().steps < 15) continue;
    ASSERT_TRUE(integrator->interpolate(t1 - 0.5 * dt, y).ok());
    exact_at(t1 - 0.5 * dt, reference);
    between = std::max(between, problem.norm(y - reference));
    const Vec line = 0.5 * (before + integrator->state());
    straight = std::max(straight, problem.norm(line - reference));
    exact_at(t1, reference);
    at_ends = std::max(at_ends, problem.norm(integrator->state() - reference));
  }
  EXPECT_LT(between, 1.5 * at_ends);
  if (GetParam() != "euler") {  // whose steps are so short that a line would do
    EXPECT_GT(straight, 3 * between);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Accuracy, ::testing::ValuesIn(backends::integrators().names()));

}  // namespace
}  // namespace traceraft::time
