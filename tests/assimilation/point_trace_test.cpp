#include "verification/assimilation/fields/point_trace.hpp"

#include <gtest/gtest.h>

#include "kernel/core/error.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::assimilation {
namespace {

using testing::make_space;
using testing::random_directions;

TEST(PointTrace, IsExactForLinearFieldsOnTheDiscreteSurface) {
  const auto space = make_space(16, "torus");
  Vec nodal(space->nodes());
  const Point slope(0.3, -1.1, 0.7);
  for (int k = 0; k < space->nodes(); ++k) nodal[k] = 2 + slope.dot(space->mesh.position(k));
  const auto& points = space->surface.position;
  const Vec values = point_trace(*space, points, 1e-9) * nodal;
  for (std::size_t k = 0; k < points.size(); ++k)
    EXPECT_NEAR(values[static_cast<Eigen::Index>(k)], 2 + slope.dot(points[k]), 1e-12);
}

TEST(PointTrace, ConvergesOnTheSurfaceItselfAtOrderTwo) {
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const auto space = make_space(16 << level);
    Vec nodal(space->nodes());
    const auto f = [](const Point& x) { return x[0] * x[1] + std::sin(2 * x[2]); };
    for (int k = 0; k < space->nodes(); ++k) nodal[k] = f(space->mesh.position(k).normalized());
    const auto points = random_directions(400);
    const Vec values = point_trace(*space, points, space->h()) * nodal;
    double squares = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
      squares += std::pow(values[static_cast<Eigen::Index>(k)] - f(points[k]), 2);
    error[level] = std::sqrt(squares / 400);
  }
  EXPECT_GT(std::log2(error[0] / error[1]), 1.7);
  EXPECT_LT(error[1], 5e-3);
}

TEST(PointTrace, RefusesAPointFarFromTheSurface) {
  const auto space = make_space(12);
  EXPECT_THROW((void)point_trace(*space, {Point(1, 0, 0), Point(0.2, 0, 0)}, space->h()),
               InputError);
}

}  // namespace
}  // namespace traceraft::assimilation
