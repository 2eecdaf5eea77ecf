// The judgement of held-out measurements on two models, on forecasts that are written down.
#include "verification/selection/search/rerun.hpp"

#include <gtest/gtest.h>

#include "kernel/core/random.hpp"

namespace traceraft::selection {
namespace {

constexpr Eigen::Index kMeasured = 1000;
constexpr double kSpread = 0.03;

// Measurements of noise around a truth of zero, held against a forecast that is off by a share of a
// wave. The state is unknown along another wave, whose amplitude has so many standard deviations of
// the noise.
assimilation::FilterResult pass_with(double share, std::uint64_t seed, double unknown = 0) {
  assimilation::FilterResult pass;
  for (const bool held_out : {false, true}) {
    assimilation::Innovation in{};
    in.held_out = held_out;
    in.noise = Vec::Constant(kMeasured, kSpread);
    const Vec place = 0.05 * Vec::LinSpaced(kMeasured, 0, kMeasured - 1);
    in.directions = unknown * (place.array() + 0.7).sin().matrix();
    in.state_directions = 1;
    in.gram = in.directions.transpose() * in.directions;
    in.gap =
        normal_random(seed, 2, held_out) * in.directions - share * place.array().sin().matrix();
    for (Eigen::Index i = 0; i < kMeasured; ++i)
      in.gap[i] += normal_random(seed, held_out, static_cast<std::uint64_t>(i));
    in.values = in.gap;
    in.expected_squares = kMeasured * kSpread * kSpread;
    pass.innovations.push_back(in);
  }
  return pass;
}

TEST(Rerun, ConfirmsWhatComesCloserToTheTruth) {
  const Rerun rerun = compare_forecasts(pass_with(0.5, 1), pass_with(0, 1), 0);
  EXPECT_TRUE(rerun.confirms());
  EXPECT_FALSE(rerun.refutes());
  EXPECT_NEAR(rerun.gain, kMeasured * 0.25 / 2, 60);  // of the mean square of the wave
  EXPECT_NEAR(rerun.floor.heldout, kSpread, 1e-12);
}

TEST(Rerun, RefutesWhatGoesAwayFromIt) {
  const Rerun rerun = compare_forecasts(pass_with(0, 1), pass_with(0.5, 1), 0);
  EXPECT_FALSE(rerun.confirms());
  EXPECT_TRUE(rerun.refutes());
}

// If the found model is the truth, it falls short of that by chance in one case of a hundred only,
// however little it differs from the base, and however little is known of the state. Of 1,000
// trials more than 21 do with a probability of 7e-4, and if it were three of a hundred with 95 %.
TEST(Rerun, SeldomRefutesTheTruth) {
  constexpr int kTrials = 1000;
  for (const double unknown : {0.0, 0.3}) {
    int refuted = 0;
    double squares = 0;
    for (std::uint64_t k = 1; k <= kTrials; ++k) {
      const Rerun rerun =
          compare_forecasts(pass_with(0.05, k, unknown), pass_with(0, k, unknown), 0);
      refuted += rerun.refutes();
      squares += rerun.shortfall * rerun.shortfall / kTrials;
    }
    EXPECT_LE(refuted, 21) << unknown;
    EXPECT_GT(refuted, 0) << unknown;
    EXPECT_NEAR(squares, 1, 0.25) << unknown;
  }
}

// Forecasts are no better than their mesh.
TEST(Rerun, DoesNotRefuteByErrorsOfTheMesh) {
  const assimilation::FilterResult base = pass_with(0, 1), found = pass_with(0.5, 1);
  const double shortfall = compare_forecasts(base, found, 0).shortfall;
  // Half of the error, times the root of the number of values, is what it may be.
  const double enough = 2 * shortfall / std::sqrt(kMeasured);
  EXPECT_TRUE(compare_forecasts(base, found, 0.5 * enough).refutes());
  EXPECT_FALSE(compare_forecasts(base, found, enough).refutes());
}

TEST(Rerun, SaysNothingOfModelsThatAreAlike) {
  const Rerun rerun = compare_forecasts(pass_with(0.1, 1), pass_with(0.1, 1), 0);
  EXPECT_FALSE(rerun.confirms());
  EXPECT_FALSE(rerun.refutes());
}

}  // namespace
}  // namespace traceraft::selection
