// Noise that neighbours share: its correlation, its whitening, and how it is drawn and found again.
#include "verification/explain/fields/noise_correlation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>
#include <stdexcept>

#include "kernel/core/random.hpp"
#include "tests/support/spaces.hpp"
#include "verification/explain/blind/noise_waves.hpp"
#include "verification/explain/filter/correlation_fit.hpp"
#include "verification/explain/filter/field_noise.hpp"
#include "verification/explain/filter/variance_components.hpp"

namespace traceraft {
namespace {

using Eigen::MatrixXd;
using testing::random_directions;

Vec white_noise(Eigen::Index count, std::uint64_t stream) {
  Vec result(count);
  for (Eigen::Index i = 0; i < count; ++i)
    result[i] = normal_random(21, stream, static_cast<std::uint64_t>(i));
  return result;
}

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
  EXPECT_EQ(traceraft::whitening(points, {}), nullptr);
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
  for (const NoiseShape shape : {NoiseShape::gaussian, NoiseShape::exponential}) {
    MatrixXd covariance = MatrixXd::Zero(4, 4);
    for (std::uint64_t k = 0; k < kDraws; ++k) {
      const Vec x = noise_waves(points, 0.1, shape, 3, k);
      covariance += x * x.transpose() / kDraws;
    }
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const double d = (points[i] - points[j]).norm() / 0.1;
        const double expected = shape == NoiseShape::gaussian ? std::exp(-d * d / 2) : std::exp(-d);
        // Standard deviation of a product's mean: at most √(2/400).
        EXPECT_NEAR(covariance(i, j), expected, 0.2) << i << j;
      }
  }
}

// Blocks of two snapshots of noise beside a state that is unknown in one direction.
struct Drawn {
  std::vector<NoiseBlock> blocks;
  static constexpr int kPoints = 2000;

  Drawn(double share, double length, NoiseShape shape, std::uint64_t first = 0) {
    for (std::uint64_t s = first; s < first + 4; ++s) {
      std::vector<Point> points;
      for (std::uint64_t i = 0; i < kPoints; ++i)
        points.push_back(testing::random_direction(10 + s, i));
      Vec noise = std::sqrt(1 - share) * white_noise(kPoints, s);
      if (share > 0) noise += std::sqrt(share) * noise_waves(points, length, shape, 5, s);
      Vec direction(kPoints);
      for (int i = 0; i < kPoints; ++i) direction[i] = 0.2 * points[i][2];
      const Vec values = 0.1 * noise + direction;
      for (const BlockRows& rows : compact_blocks(points, 100)) {
        const Vec own = direction(rows);
        blocks.push_back({values(rows), own * own.transpose(), Vec::Constant(own.size(), 0.05),
                          distances(points, rows)});
      }
    }
  }
  double spacing() const { return std::sqrt(4 * kPi / kPoints); }
};

TEST(CorrelationFit, FindsNoneInWhiteNoise) {
  const Drawn drawn(0, 0, NoiseShape::gaussian);
  const ThreadTeam team(2);
  const CorrelationFit fit = fit_correlation(drawn.blocks, drawn.spacing(), team);
  EXPECT_TRUE(fit.correlation.white());
  EXPECT_NEAR(fit.variance, 4, 0.2);  // 8,000 values: 1.6 %
}

TEST(CorrelationFit, FindsShareAndLengthOfAnyShape) {
  const ThreadTeam team(2);
  struct Case {
    double share, length;
    NoiseShape shape;
  };
  for (const Case& c : {Case{0.2, 0.1, NoiseShape::gaussian}, Case{1, 0.08, NoiseShape::gaussian},
                        Case{0.6, 0.08, NoiseShape::exponential}}) {
    const Drawn drawn(c.share, c.length, c.shape);
    const CorrelationFit fit = fit_correlation(drawn.blocks, drawn.spacing(), team);
    ASSERT_FALSE(fit.correlation.white());
    EXPECT_NEAR(fit.variance, 4, 0.4);
    // How much noisier it makes a mean, which is what matters to smooth patterns.
    const double area = std::pow(drawn.spacing(), 2);
    const auto inflation = [&](double share, double length) {
      return 1 - share + share * 2 * kPi * length * length / area;
    };
    const double expected = inflation(c.share, c.length);
    EXPECT_NEAR(inflation(fit.correlation.share(), fit.correlation.length()), expected,
                0.2 * expected)
        << c.share << " over " << c.length;
    // The tail of an exponential is a long one.
    EXPECT_EQ(fit.correlation.at_bound, c.shape == NoiseShape::exponential);
    EXPECT_NEAR(fit_variance(drawn.blocks, fit.correlation, team), fit.variance,
                0.02 * fit.variance);
  }
}

// How much noise smooth patterns have is known to some error, which the fit states.
TEST(CorrelationFit, StatesItsErrorOverSmoothPatterns) {
  constexpr int kDraws = 8;
  const ThreadTeam team(2);
  double squares = 0, stated = 0;
  for (int k = 0; k < kDraws; ++k) {
    const Drawn drawn(0.3, 0.1, NoiseShape::gaussian, 4 * static_cast<std::uint64_t>(k));
    const CorrelationFit fit = fit_correlation(drawn.blocks, drawn.spacing(), team);
    ASSERT_FALSE(fit.correlation.white());
    const double density = 1 / std::pow(drawn.spacing(), 2);
    const auto smooth = [&](double share, double length) {
      return 1 - share + share * 2 * kPi * length * length * density;
    };
    const double found = fit.variance * smooth(fit.correlation.share(), fit.correlation.length());
    squares += std::pow(std::log(found / (4 * smooth(0.3, 0.1))), 2) / kDraws;
    stated += fit.correlation.error / kDraws;
  }
  EXPECT_LT(std::sqrt(squares) / stated, 2);
  EXPECT_GT(std::sqrt(squares) / stated, 0.7);
}

// Measured fields alone give an estimate, which takes nothing of a smooth field for noise.
TEST(FieldNoise, IsFoundInFlatParts) {
  for (const double share : {0.0, 0.5}) {
    std::vector<FieldSeries> series{{"1", {}}};
    for (std::uint64_t s = 0; s < 4; ++s) {
      FieldSnapshot snapshot{double(s), {}, {}, Vec::Ones(2000)};
      for (std::uint64_t i = 0; i < 2000; ++i)
        snapshot.points.push_back(testing::random_direction(10 + s, i));
      Vec noise = std::sqrt(1 - share) * white_noise(2000, s);
      if (share > 0)
        noise += std::sqrt(share) * noise_waves(snapshot.points, 0.08, NoiseShape::gaussian, 5, s);
      snapshot.values = 0.05 * noise;
      for (int i = 0; i < 2000; ++i)
        snapshot.values[i] += 0.5 + 0.5 * std::tanh((snapshot.points[i][2] - 0.3) / 0.25);
      series[0].snapshots.push_back(snapshot);
    }
    const auto found = noise_of_fields(series, 2);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->level, 0.05, 0.005);
    EXPECT_NEAR(found->correlation.share(), share, 0.15);
    if (share > 0) {
      EXPECT_NEAR(found->correlation.length(), 0.08, 0.03);
    }
  }
  EXPECT_FALSE(noise_of_fields({}, 1));
}

TEST(CorrelationFit, SaysWhereItIsAsLongAsItMayBe) {
  const Drawn drawn(0.5, 0.4, NoiseShape::gaussian);
  const CorrelationFit fit = fit_correlation(drawn.blocks, drawn.spacing(), ThreadTeam(2));
  EXPECT_TRUE(fit.correlation.at_bound);
  EXPECT_NE(text_of(fit.correlation).find("or more"), std::string::npos);
}

TEST(CorrelationFit, DoesNotDependOnTheNumberOfThreads) {
  const Drawn drawn(0.2, 0.1, NoiseShape::gaussian);
  const auto share = [&](int threads) {
    return fit_correlation(drawn.blocks, drawn.spacing(), ThreadTeam(threads)).correlation.share();
  };
  EXPECT_EQ(share(1), share(2));
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
}  // namespace traceraft
