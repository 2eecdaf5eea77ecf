// The noise of measurements, as innovations tell it.
#include "verification/assimilation/filter/noise_levels.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace traceraft::assimilation {
namespace {

// A vesicle with five snapshots, the last of which is held out.
FilterProblems vesicle() {
  FilterProblem problem;
  problem.vesicle = 0;
  problem.train = 4;
  problem.noise.assign(5, 1.0);
  for (int k = 0; k < 5; ++k) {
    problem.snapshots.push_back({{}, {}, Vec::Constant(3, 0.1)});
    problem.series.snapshots.push_back({double(k), {}, Vec(Eigen::Vector2d(0, 1)), {}});
  }
  return {problem};
}

// Innovations of the second snapshot and later, that are so many times what the noise allows for.
FilterResult pass(const std::vector<double>& factors) {
  FilterResult result;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    Innovation in{};
    in.vesicle = 0;
    in.snapshot = k + 1;
    in.values = Vec::Zero(7);
    in.weighted_squares = 7 * factors[k] * factors[k];
    result.innovations.push_back(in);
  }
  return result;
}

TEST(NoiseLevels, AreOneForAllThatNearlyAgree) {
  FilterProblems data = vesicle();
  fit_noise(data, pass({1.1, 1.2, 1.15, 1.2}));
  const double common = std::sqrt((1.1 * 1.1 + 1.2 * 1.2 + 1.15 * 1.15) / 3);
  for (const double noise : data.front().noise) EXPECT_NEAR(noise, common, 1e-12);
}

TEST(NoiseLevels, AreTheirOwnWhereSnapshotsStateThemWrongly) {
  FilterProblems data = vesicle();
  fit_noise(data, pass({1, 2, 1, 0.5}));
  const std::vector<double> expected{1, 1, 2, 1, 0.5};
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(data.front().noise[k], expected[k], 1e-12) << k;
}

// The snapshot that is held out says nothing of the others.
TEST(NoiseLevels, DoNotLookAtWhatIsHeldOut) {
  FilterProblems data = vesicle(), same = vesicle();
  fit_noise(data, pass({1, 1.1, 1.2, 1}));
  fit_noise(same, pass({1, 1.1, 1.2, 1.24}));
  EXPECT_EQ(data.front().noise, same.front().noise);
}

TEST(NoiseLevels, GoOnFromTheNoiseOfThePass) {
  FilterProblems data = vesicle();
  fit_noise(data, pass({1.1, 1.1, 1.1, 1.1}));
  fit_noise(data, pass({1.1, 1.1, 1.1, 1.1}));
  EXPECT_NEAR(data.front().noise[2], 1.21, 1e-12);
  EXPECT_NEAR(noise_of(data), 0.121, 1e-12);  // in c: deviations of 0.1 are stated
}

TEST(NoiseLevels, AreNoPartOfTheContrast) {
  FilterProblems data = vesicle();
  EXPECT_NEAR(contrast_of(data), std::sqrt(0.25 - 0.01), 1e-12);
}

}  // namespace
}  // namespace traceraft::assimilation
