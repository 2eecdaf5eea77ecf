#include "kernel/flow/harmonic_multiplier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/spaces.hpp"

namespace traceraft::flow {
namespace {

using testing::random_directions;
using testing::random_vector;

// Both poles, and places where angles begin.
std::vector<Point> places() {
  std::vector<Point> points = random_directions(300);
  for (const Point& point : {Point(0, 0, 1), Point(0, 0, -1), Point(1, 0, 0), Point(1, -1e-17, 0)})
    points.push_back(point);
  for (std::size_t k = 0; k < points.size(); ++k)
    points[k] *= 0.5 + 0.1 * static_cast<double>(k % 9);
  return points;
}

HarmonicMultiplier multiplier(const Vec& gain, int threads = 1) {
  return {places(), gain, std::make_shared<ThreadTeam>(threads)};
}

// The addition theorem: Σ_m Y_lm(x) Y_lm(y) = (2l + 1)/(4π) P_l(x·y).
double error_of_degree(int l, int degree) {
  const std::vector<Point> points = places();
  Vec gain = Vec::Zero(degree + 1);
  gain[l] = 1;
  const HarmonicMultiplier one = multiplier(gain);
  double error = 0;
  for (std::size_t k : {std::size_t{0}, points.size() - 4, points.size() - 1}) {
    const Vec u = one.apply(Vec::Unit(static_cast<Eigen::Index>(points.size()), k));
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double cosine = points[k].normalized().dot(points[j].normalized());
      const double exact = std::legendre(static_cast<unsigned>(l), std::clamp(cosine, -1.0, 1.0));
      error = std::max(error, std::fabs(4 * kPi / (2 * l + 1) * u[static_cast<int>(j)] - exact));
    }
  }
  return error;
}

TEST(HarmonicMultiplier, MultipliesEachDegreeByItsGain) {
  EXPECT_LT(error_of_degree(0, 20), 1e-12);
  EXPECT_LT(error_of_degree(1, 20), 1e-10);
  EXPECT_LT(error_of_degree(5, 20), 2e-6);
  EXPECT_LT(error_of_degree(10, 20), 5e-4);  // half of the highest
  EXPECT_LT(error_of_degree(20, 20), 0.05);
}

TEST(HarmonicMultiplier, IsSymmetricAndPositive) {
  Vec gain = Vec::Zero(17);
  for (int l = 1; l <= 16; ++l) gain[l] = 1 / std::pow(l, 4);
  const HarmonicMultiplier multiplied = multiplier(gain);
  const auto size = static_cast<Eigen::Index>(places().size());
  const Vec a = random_vector(size, 1), b = random_vector(size, 2);
  const Vec of_a = multiplied.apply(a), of_b = multiplied.apply(b);
  EXPECT_NEAR(a.dot(of_b), b.dot(of_a), 1e-13 * a.norm() * of_b.norm());
  EXPECT_GT(a.dot(of_a), 0);
}

TEST(HarmonicMultiplier, IsTheSameOnAnyNumberOfThreads) {
  const Vec gain = Vec::LinSpaced(13, 0, 1);
  const Vec b = random_vector(static_cast<Eigen::Index>(places().size()), 3);
  const Vec one = multiplier(gain).apply(b);
  for (const int threads : {2, 3}) EXPECT_EQ(multiplier(gain, threads).apply(b), one) << threads;
}

}  // namespace
}  // namespace traceraft::flow
