// Noise that neighbours share, found again.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/random.hpp"
#include "tests/support/spaces.hpp"
#include "verification/assimilation/filter/correlation_fit.hpp"
#include "verification/assimilation/filter/field_noise.hpp"
#include "verification/selection/blind/noise_waves.hpp"

namespace traceraft::assimilation {
namespace {

Vec white_noise(Eigen::Index count, std::uint64_t stream) {
  Vec result(count);
  for (Eigen::Index i = 0; i < count; ++i)
    result[i] = normal_random(21, stream, static_cast<std::uint64_t>(i));
  return result;
}

// Blocks of two snapshots of noise beside a state that is unknown in one direction.
struct Drawn {
  std::vector<NoiseBlock> blocks;
  static constexpr int kPoints = 2000;

  Drawn(double share, double length, selection::NoiseShape shape, std::uint64_t first = 0) {
    for (std::uint64_t s = first; s < first + 4; ++s) {
      std::vector<Point> points;
      for (std::uint64_t i = 0; i < kPoints; ++i)
        points.push_back(testing::random_direction(10 + s, i));
      Vec noise = std::sqrt(1 - share) * white_noise(kPoints, s);
      if (share > 0)
        noise += std::sqrt(share) * selection::noise_waves(points, length, shape, 5, s);
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
  const Drawn drawn(0, 0, selection::NoiseShape::gaussian);
  const ThreadTeam team(2);
  const CorrelationFit fit = fit_correlation(drawn.blocks, drawn.spacing(), team);
  EXPECT_TRUE(fit.correlation.white());
  EXPECT_NEAR(fit.variance, 4, 0.2);  // 8,000 values: 1.6 %
}

TEST(CorrelationFit, FindsShareAndLengthOfAnyShape) {
  const ThreadTeam team(2);
  struct Case {
    double share, length;
    selection::NoiseShape shape;
  };
  for (const Case& c : {Case{0.2, 0.1, selection::NoiseShape::gaussian},
                        Case{1, 0.08, selection::NoiseShape::gaussian},
                        Case{0.6, 0.08, selection::NoiseShape::exponential}}) {
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
    EXPECT_EQ(fit.correlation.at_bound, c.shape == selection::NoiseShape::exponential);
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
    const Drawn drawn(0.3, 0.1, selection::NoiseShape::gaussian, 4 * static_cast<std::uint64_t>(k));
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
        noise += std::sqrt(share) * selection::noise_waves(snapshot.points, 0.08,
                                                           selection::NoiseShape::gaussian, 5, s);
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
  const Drawn drawn(0.5, 0.4, selection::NoiseShape::gaussian);
  const CorrelationFit fit = fit_correlation(drawn.blocks, drawn.spacing(), ThreadTeam(2));
  EXPECT_TRUE(fit.correlation.at_bound);
  EXPECT_NE(text_of(fit.correlation).find("or more"), std::string::npos);
}

TEST(CorrelationFit, DoesNotDependOnTheNumberOfThreads) {
  const Drawn drawn(0.2, 0.1, selection::NoiseShape::gaussian);
  const auto share = [&](int threads) {
    return fit_correlation(drawn.blocks, drawn.spacing(), ThreadTeam(threads)).correlation.share();
  };
  EXPECT_EQ(share(1), share(2));
}

}  // namespace
}  // namespace traceraft::assimilation
