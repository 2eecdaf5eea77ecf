#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kernel/core/random.hpp"
#include "verification/statistics/bootstrap.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft {
namespace {

TEST(Fit, LinesAndPowerLawsAreExact) {
  const statistics::Line line = statistics::fit_line({{1, 5}, {2, 7}, {4, 11}});
  EXPECT_NEAR(line.slope, 2, 1e-14);
  EXPECT_NEAR(line.intercept, 3, 1e-14);
  // Least squares, not the ends: by hand for (0,0), (1,1), (2,0).
  EXPECT_NEAR(statistics::fit_line({{0, 0}, {1, 1}, {2, 0}}).intercept, 1.0 / 3, 1e-14);
  statistics::Points points;
  for (const double t : {0.5, 1.0, 3.0, 20.0}) points.emplace_back(t, 4 * std::pow(t, -1.0 / 3));
  EXPECT_NEAR(statistics::fit_power_law(points).slope, -1.0 / 3, 1e-14);
  EXPECT_THROW(statistics::fit_line({{1, 1}, {1, 2}}), std::runtime_error);
}

TEST(Fit, APowerLawFindsItsOrigin) {
  for (const double t0 : {0.5, 0.0, -0.7, -3.0}) {
    statistics::Points points;
    for (double t = 1; t < 60; t *= 1.1) points.emplace_back(t, 4 * std::pow(t - t0, -1.0 / 3));
    const statistics::PowerLaw found = statistics::fit_power_law_from(points);
    EXPECT_NEAR(found.b, -1.0 / 3, 1e-4) << t0;
    EXPECT_NEAR(found.t0, t0, 1e-3) << t0;
    EXPECT_NEAR(found.c, 4, 0.01) << t0;
    // An origin that is not allowed to be that late.
    EXPECT_NEAR(statistics::fit_power_law_from(points, 0).t0, std::min(t0, 0.0), 1e-3) << t0;
  }
}

TEST(Fit, OrdersAreBetweenTheFinestLevels) {
  const statistics::ObservedOrder found = statistics::observed_order({{1, 8}, {0.5, 4}, {0.25, 1}});
  EXPECT_NEAR(found.order, 2, 1e-14);
  EXPECT_NEAR(found.change, 1, 1e-14);
  EXPECT_EQ(statistics::observed_order({{1, 8}, {0.5, 4}}).change, 0);
}

// The interval for a mean has the width of theory, and misses it about as often as it may.
TEST(Fit, TheBootstrapKnowsHowFarAMeanIsOff) {
  constexpr int kCount = 40, kTrials = 200;
  int missed = 0;
  double width = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(kCount);
    for (int k = 0; k < kCount; ++k)
      values[k] = uniform_random(5, trial, static_cast<std::uint64_t>(k));
    const statistics::Interval interval =
        statistics::bootstrap(kCount, 400, 0.95, trial, [&](const std::vector<int>& sample) {
          double sum = 0;
          for (const int k : sample) sum += values[k];
          return sum / kCount;
        });
    missed += interval.contains(0.5) ? 0 : 1;
    width += (interval.high - interval.low) / kTrials;
  }
  EXPECT_NEAR(width, 2 * 1.96 * std::sqrt(1.0 / 12 / kCount), 0.01);
  EXPECT_LT(missed, 0.12 * kTrials);
  EXPECT_GT(missed, 0.01 * kTrials);
}

// 95 % of the means of six numbers have to lie in their intervals.
TEST(Bootstrap, IsWidenedForFew) {
  EXPECT_NEAR(statistics::factor_for_few(6), 2.5706 / 1.96 * std::sqrt(6.0 / 5), 0.005);
  EXPECT_NEAR(statistics::factor_for_few(4), 3.1824 / 1.96 * std::sqrt(4.0 / 3), 0.02);
  EXPECT_NEAR(statistics::factor_for_few(1000), 1, 0.002);
  constexpr int kTrials = 400, kCount = 6;
  int missed = 0, missed_before = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(kCount);
    for (int k = 0; k < kCount; ++k)
      values[k] = normal_random(7, trial, static_cast<std::uint64_t>(k));
    const auto mean = [&](const std::vector<int>& sample) {
      double sum = 0;
      for (const int k : sample) sum += values[k];
      return sum / kCount;
    };
    const statistics::Interval percentiles = statistics::bootstrap(kCount, 400, 0.95, trial, mean);
    missed_before += percentiles.contains(0) ? 0 : 1;
    missed += statistics::widened_for_few(percentiles, mean(statistics::each_once(kCount)), kCount)
                      .contains(0)
                  ? 0
                  : 1;
  }
  EXPECT_GT(missed_before, 0.09 * kTrials);
  EXPECT_NEAR(missed, 0.05 * kTrials, 0.03 * kTrials);
}

TEST(Sample, KnowsItsMomentsAndQuantiles) {
  const statistics::Sample s = statistics::sample_of({5, 1, 4, 2, 3});
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.deviation, std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(s.median, 3);
  EXPECT_DOUBLE_EQ(s.q25, 2);
  EXPECT_DOUBLE_EQ(s.q90, 4.6);
  EXPECT_DOUBLE_EQ(s.min, 1);
  EXPECT_DOUBLE_EQ(s.max, 5);
  EXPECT_DOUBLE_EQ(statistics::sample_of({4, 1, 2, 3}).median, 2.5);
  EXPECT_DOUBLE_EQ(statistics::sample_of({7}).deviation, 0);
  EXPECT_DOUBLE_EQ(statistics::quantile({7}, 0.3), 7);
}

}  // namespace
}  // namespace traceraft
