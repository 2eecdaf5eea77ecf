#include "verification/assimilation/fields/field_estimate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/support/spaces.hpp"

namespace traceraft::assimilation {
namespace {

using testing::make_space;

constexpr double kTrueNoise = 0.05;
constexpr int kMeasured = 3000;

// Two caps with smooth boundaries.
double field(const Point& x) {
  return 0.5 + 0.5 * std::tanh((std::fabs(x[2] + 0.2 * x[0]) - 0.6) / 0.2);
}

struct Measured {
  std::shared_ptr<const fem::SurfaceSpace> space = make_space(16);
  std::vector<Point> points;
  NoisyValues values;

  Measured() {
    values.values.resize(kMeasured);
    values.deviation = Vec::Ones(kMeasured);
    for (int k = 0; k < kMeasured; ++k) {
      points.push_back(testing::random_direction(5, static_cast<std::uint64_t>(k)));
      const double noise = normal_pair(uniform_random(5, 3, k), uniform_random(5, 4, k))[0];
      values.values[k] = field(points.back()) + kTrueNoise * noise;
    }
    values.trace = point_trace(*space, points, space->h());
  }
};

TEST(FieldEstimate, FindsTheNoiseAndAveragesItOut) {
  const Measured m;
  const FieldEstimate estimate = estimate_field(*m.space, m.values, {});
  EXPECT_NEAR(estimate.noise, kTrueNoise, 0.1 * kTrueNoise);
  const Vec values = m.values.trace * estimate.field;
  double squares = 0;
  for (int k = 0; k < kMeasured; ++k) squares += std::pow(values[k] - field(m.points[k]), 2);
  EXPECT_LT(std::sqrt(squares / kMeasured), 0.6 * kTrueNoise);
}

TEST(FieldEstimate, ErrorsAreThoseOfARegression) {
  const Measured m;
  const FieldEstimate estimate = estimate_field(*m.space, m.values, {0.4, 80, 400});
  // ∫ f e for a smooth f: as of the mean of that many measurements.
  for (int axis = 0; axis < 3; ++axis) {
    Vec f(m.space->nodes());
    for (int k = 0; k < m.space->nodes(); ++k) f[k] = m.space->mesh.position(k)[axis];
    Vec load(m.space->nodes());
    m.space->mass.multiply(f, load, *m.space->team);
    const double expected =
        estimate.noise * std::sqrt(m.space->inner(f, f) * m.space->area / kMeasured);
    EXPECT_NEAR((estimate.errors.transpose() * load).norm(), expected, 0.2 * expected);
    EXPECT_NEAR((estimate.draws.transpose() * load).norm() / std::sqrt(400), expected,
                0.25 * expected);
  }
}

TEST(FieldEstimate, CompressKeepsTheLargestDirections) {
  const auto space = make_space(8);
  Eigen::SparseMatrix<double> identity(space->nodes(), space->nodes());
  identity.setIdentity();
  Eigen::MatrixXd X(space->nodes(), 4);
  for (int k = 0; k < 4; ++k)
    X.col(k) =
        testing::random_vector(space->nodes(), static_cast<std::uint64_t>(k)) * std::pow(0.1, k);
  const Eigen::MatrixXd before = X * X.transpose();
  Eigen::MatrixXd all = X, few = X;
  compress(identity, all, 10);
  compress(identity, few, 2);
  EXPECT_LT((all * all.transpose() - before).norm(), 1e-9 * before.norm());
  EXPECT_EQ(few.cols(), 2);
  EXPECT_LT((few * few.transpose() - before).norm(), 1e-3 * before.norm());
}

}  // namespace
}  // namespace traceraft::assimilation
