// Noise that neighbours share: its correlation, its whitening, and how it is drawn.
#include "verification/assimilation/fields/noise_correlation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>
#include <stdexcept>

#include "tests/support/spaces.hpp"
#include "verification/assimilation/filter/variance_components.hpp"
#include "verification/selection/blind/noise_waves.hpp"

namespace traceraft::assimilation {
namespace {

using Eigen::MatrixXd;
using testing::random_directions;

MatrixXd dense(const std::vector<Point>& points, const NoiseCorrelation& correlation) {
  const auto n = static_cast<Eigen::Index>(points.size());
  MatrixXd R(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      R(i, j) = i == j ? 1 : correlation.at((points[i] - points[j]).norm());
  return R;
}

TEST(NoiseCorrelation, IsNearAGaussianOfItsLength) {
  const NoiseCorrelation correlation = gaussian_correlation(0.1, 0.8);
  EXPECT_DOUBLE_EQ(correlation.share(), 0.8);
  EXPECT_NEAR(correlation.length(), 0.1, 1e-15);
  double integral = 0, furthest = 0;
  constexpr double kStep = 1e-4;
  for (double d = kStep / 2; d < 1; d += kStep) {
    integral += 2 * kPi * d * kStep * correlation.at(d) / 0.8;
    furthest =
        std::max(furthest, std::fabs(correlation.at(d) / 0.8 - std::exp(-d * d / (2 * 0.1 * 0.1))));
  }
  EXPECT_NEAR(integral, 2 * kPi * 0.1 * 0.1, 1e-6);
  EXPECT_LT(furthest, 0.02);
  EXPECT_EQ(correlation.at(correlation.support()), 0);
  EXPECT_TRUE(NoiseCorrelation{}.white());
  EXPECT_EQ(text_of(NoiseCorrelation{}), "white");
  EXPECT_NE(text_of(correlation).find("80 %"), std::string::npos);
}

TEST(NoiseWhitening, IsARootOfTheDenseMatrix) {
  const std::vector<Point> points = random_directions(200);
  NoiseCorrelation correlation = gaussian_correlation(0.1, 0.5);
  correlation.components.push_back({0.2, 0.3});
  const NoiseWhitening whitening(points, correlation);
  const MatrixXd R = dense(points, correlation), one = MatrixXd::Identity(200, 200);
  EXPECT_TRUE(MatrixXd(whitening.correlations()).isApprox(R, 1e-14));
  const MatrixXd root = whitening.coloured(one);
  EXPECT_TRUE((root * root.transpose()).isApprox(R, 1e-12));
  EXPECT_TRUE(whitening.whitened(root).isApprox(one, 1e-10));
  EXPECT_EQ(whitening.whitened(MatrixXd(200, 0)).cols(), 0);
  EXPECT_EQ(whitening.coloured(MatrixXd(200, 0)).cols(), 0);
  EXPECT_EQ(assimilation::whitening(points, {}), nullptr);
}

TEST(NoiseWhitening, RefusesWhatIsNoCorrelation) {
  EXPECT_THROW(NoiseWhitening(random_directions(400), gaussian_correlation(0.2, 40)),
               std::runtime_error);
}

TEST(CompactBlocks, HoldEveryPointOnce) {
  const std::vector<Point> points = random_directions(1000);
  std::set<Eigen::Index> seen;
  for (const BlockRows& block : compact_blocks(points, 70)) {
    EXPECT_LE(block.size(), 70u);
    EXPECT_GE(block.size(), 35u);
    const MatrixXd distance = distances(points, block);
    EXPECT_LT(distance.maxCoeff(), 1.5);
    EXPECT_EQ(distance(0, 1), (points[block[0]] - points[block[1]]).norm());
    seen.insert(block.begin(), block.end());
  }
  EXPECT_EQ(seen.size(), points.size());
}

// Over many draws: the covariance of values at a distance.
TEST(NoiseWaves, HaveTheirCorrelation) {
  const std::vector<Point> points{{0, 0, 1}, {0.05, 0, 1}, {0, 0.1, 1}, {0.3, 0, 1}};
  constexpr int kDraws = 400;
  for (const selection::NoiseShape shape :
       {selection::NoiseShape::gaussian, selection::NoiseShape::exponential}) {
    MatrixXd covariance = MatrixXd::Zero(4, 4);
    for (std::uint64_t k = 0; k < kDraws; ++k) {
      const Vec x = selection::noise_waves(points, 0.1, shape, 3, k);
      covariance += x * x.transpose() / kDraws;
    }
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const double d = (points[i] - points[j]).norm() / 0.1;
        const double expected =
            shape == selection::NoiseShape::gaussian ? std::exp(-d * d / 2) : std::exp(-d);
        // Standard deviation of a product's mean: at most √(2/400).
        EXPECT_NEAR(covariance(i, j), expected, 0.2) << i << j;
      }
  }
}

// Two values: their mean square, whatever the weights.
TEST(VarianceComponents, FitOneVariance) {
  NoiseBlock block{Eigen::Vector2d(3, 1), MatrixXd::Zero(2, 2), Vec::Constant(2, 2.0),
                   MatrixXd::Zero(2, 2)};
  block.distance(0, 1) = block.distance(1, 0) = 1;
  const ThreadTeam team(1);
  const std::vector<NoiseBlock> blocks{block};
  const VarianceComponents white(blocks, team, {[](double) { return 0.0; }});
  EXPECT_NEAR(white.fit(Vec::Ones(1), {true}).variances[0], 10.0 / 8, 1e-12);
  // Two components: σ² and its share ρ that both have, of which (σ² ρ) is the product 3 of the two.
  const VarianceComponents shared(blocks, team,
                                  {[](double) { return 0.0; }, [](double) { return 0.9; }});
  const Vec both = shared.fit(Vec::Ones(2), {true, true}).variances;
  EXPECT_NEAR(both.sum(), 10.0 / 8, 1e-9);
  EXPECT_NEAR(0.9 * both[1], 3.0 / 4, 1e-9);
  EXPECT_NEAR(white.score_gain(Vec::Constant(1, 10.0 / 8), {true}), 0, 1e-12);
}

}  // namespace
}  // namespace traceraft::assimilation
