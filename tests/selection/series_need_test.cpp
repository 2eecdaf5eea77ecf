#include "verification/selection/series/series_need.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/random.hpp"
#include "verification/selection/search/judgement.hpp"

namespace traceraft::selection {
namespace {

constexpr double kSquare = kSeen * kSeen;

// The square of what an effect does with f times as many vesicles, beyond what another D does.
double square(const SeriesProducts& p, double f) {
  return f * p.ee - std::pow(f * p.ue, 2) / (f * p.uu + p.known);
}

TEST(SeriesNeed, EffectIsSeenAtWhatIsNeeded) {
  const SeriesProducts p{12, 3, 5, 2};
  const double constant = times_needed(p, {1.5, 1.5});
  EXPECT_GE(square(p, constant), kSquare * 1.5);
  EXPECT_LT(square(p, constant / 1.01), kSquare * 1.5);
  // Noise that grows with the number of vesicles takes more of them.
  const double growing = times_needed(p, {1, 4.5});
  EXPECT_GT(growing, constant);
  EXPECT_NEAR(square(p, growing), kSquare * (1 + 0.5 * (growing - 1)), 0.02 * kSquare);
}

TEST(SeriesNeed, NoiseMayGrowAsFast) {
  EXPECT_TRUE(std::isinf(times_needed({12, 0, 5, 2}, {1, 8})));
}

// Where the square saturates it may be seen now, and no more by eight times as many.
TEST(SeriesNeed, WhatIsSeenNowIsNoLess) {
  const double f = times_needed({48, std::sqrt(4800.0), 100, 100}, {1, 3.1});
  EXPECT_LT(f, 1);
  EXPECT_GT(f, 0.1);
}

// The mean of three runs is off, which eight times as many vesicles see.
TEST(SeriesNeed, NoiseOfMoreVesiclesHasThatOfTheRuns) {
  const auto run = [](std::uint64_t seed, double more) {
    observations::History history;
    for (int k = 0; k <= 40; ++k) {
      const double t = std::pow(10.0, k / 20.0);
      history.time.push_back(t);
      history.of(observations::Quantity::perimeter).push_back(20 * std::pow(t, -0.3));
      history.of(observations::Quantity::rafts).push_back(5);
      history.of(observations::Quantity::fraction)
          .push_back(0.1 * std::exp((more + 0.1 * normal_random(seed, 1, 0)) * std::log(t)));
    }
    return history;
  };
  std::vector<observations::History> runs;
  SeriesCandidate uptake{"uptake", {{1, {}}}, true};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    runs.push_back(run(seed, 0));
    uptake.levels[0].runs.push_back(run(seed, 0.2));
  }
  observations::MeasuredVesicles data;
  for (int v = 0; v < 6; ++v)
    for (const double t : {2.0, 8.0, 30.0}) {
      observations::Measurement m{std::to_string(v), t, 5, {}, {}};
      for (const observations::Quantity quantity : observations::kQuantities)
        m.values[observations::index_of(quantity)] = runs[0].at(quantity, t);
      data.measurements.push_back(m);
    }
  const likelihood::UnitPrior unit = likelihood::UnitPrior::within_factor(1, 2);
  likelihood::EnsembleFit fit;
  fit.scatter = {{0.02, 0.02, 0.02}, {0.02, 0.02, 0.02}};
  const SeriesNull null = null_of(data, runs, {uptake}, fit, unit, 99);
  const std::vector<SeriesNoise> noise = noise_of_more(data, runs, {uptake}, fit, unit, null);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_EQ(noise[0].now, null.mean[0]);
  EXPECT_GT(noise[0].most, 2 * noise[0].now);
}

// A change that another D makes as well is not seen by any number, unless D is known.
TEST(SeriesNeed, AnotherDMayDoTheSame) {
  EXPECT_TRUE(std::isinf(times_needed({20, 10, 5, 0.1}, {1, 1})));
  EXPECT_TRUE(std::isfinite(times_needed({20, 10, 5, 1000}, {1, 1})));
}

}  // namespace
}  // namespace traceraft::selection
