#include "kernel/flow/harmonic_transform.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/support/harmonics.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::flow {
namespace {

using testing::exact_harmonic;
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

HarmonicTransform transform(int degree, int threads = 1) {
  return {places(), degree, std::make_shared<ThreadTeam>(threads)};
}

double error_of_degree(int l, int degree) {
  const std::vector<Point> points = places();
  const HarmonicTransform harmonics = transform(degree);
  double error = 0;
  for (const int m : {-l, -l / 2, 0, l / 3, l}) {
    const Vec values = harmonics.synthesis(Vec::Unit(harmonics.size(), harmonic_index(l, m)));
    for (std::size_t k = 0; k < points.size(); ++k)
      error = std::max(
          error, std::fabs(values[static_cast<Eigen::Index>(k)] - exact_harmonic(l, m, points[k])));
  }
  return error;
}

TEST(HarmonicTransform, HasTheHarmonicsAtThePoints) {
  EXPECT_LT(error_of_degree(0, 20), 1e-13);
  EXPECT_LT(error_of_degree(1, 20), 1e-10);
  EXPECT_LT(error_of_degree(5, 20), 2e-6);
  EXPECT_LT(error_of_degree(10, 20), 5e-4);  // half of the highest
  EXPECT_LT(error_of_degree(20, 20), 0.05);
}

TEST(HarmonicTransform, AnalysisIsTheTransposeOfSynthesis) {
  const HarmonicTransform harmonics = transform(16);
  const Vec values = random_vector(static_cast<Eigen::Index>(places().size()), 1),
            coefficients = random_vector(harmonics.size(), 2);
  const Vec analysed = harmonics.analysis(values), synthesised = harmonics.synthesis(coefficients);
  EXPECT_NEAR(analysed.dot(coefficients), values.dot(synthesised),
              1e-13 * values.norm() * synthesised.norm());
}

TEST(HarmonicTransform, IsTheSameOnAnyNumberOfThreads) {
  const HarmonicTransform one = transform(12);
  const Vec values = random_vector(static_cast<Eigen::Index>(places().size()), 3),
            coefficients = random_vector(one.size(), 4);
  for (const int threads : {2, 3}) {
    const HarmonicTransform other = transform(12, threads);
    EXPECT_EQ(other.analysis(values), one.analysis(values)) << threads;
    EXPECT_EQ(other.synthesis(coefficients), one.synthesis(coefficients)) << threads;
  }
}

}  // namespace
}  // namespace traceraft::flow
