// What held-out measurements say of two models, on forecasts that are written down.
#include "verification/explain/rerun.hpp"

#include <gtest/gtest.h>

#include "kernel/core/random.hpp"

namespace traceraft {
namespace {

constexpr Eigen::Index kValues = 1000;
constexpr double kSpread = 0.03;

// Measurements of noise around a truth of zero, held against a forecast that is off by a share of a
// wave.
FilterResult pass_with(double share, std::uint64_t seed) {
  FilterResult pass;
  for (const bool held_out : {false, true}) {
    Innovation in{};
    in.held_out = held_out;
    in.noise = Vec::Constant(kValues, kSpread);
    in.gap.resize(kValues);
    for (Eigen::Index i = 0; i < kValues; ++i)
      in.gap[i] = normal_random(seed, held_out, static_cast<std::uint64_t>(i)) -
                  share * std::sin(0.05 * static_cast<double>(i));
    in.values = in.gap;
    in.expected_squares = kValues * kSpread * kSpread;
    pass.innovations.push_back(in);
  }
  return pass;
}

TEST(Rerun, ConfirmsWhatComesCloserToTheTruth) {
  const Rerun rerun = compare_forecasts(pass_with(0.5, 1), pass_with(0, 1));
  EXPECT_TRUE(rerun.confirms());
  EXPECT_FALSE(rerun.refutes());
  EXPECT_NEAR(rerun.gain, kValues * 0.25 / 2, 60);  // of the mean square of the wave
  EXPECT_NEAR(rerun.floor.heldout, kSpread, 1e-12);
}

TEST(Rerun, RefutesWhatGoesAwayFromIt) {
  const Rerun rerun = compare_forecasts(pass_with(0, 1), pass_with(0.5, 1));
  EXPECT_FALSE(rerun.confirms());
  EXPECT_TRUE(rerun.refutes());
}

// If the found model is the truth, it falls short of that by chance in one case of a hundred only,
// however little it differs from the base.
TEST(Rerun, SeldomRefutesTheTruth) {
  int refuted = 0;
  std::vector<double> shortfalls;
  constexpr int kTrials = 400;
  for (std::uint64_t k = 1; k <= kTrials; ++k) {
    const Rerun rerun = compare_forecasts(pass_with(0.05, k), pass_with(0, k));
    refuted += rerun.refutes();
    shortfalls.push_back(rerun.shortfall);
  }
  EXPECT_LE(refuted, 12);
  double squares = 0;
  for (const double s : shortfalls) squares += s * s / kTrials;
  EXPECT_NEAR(squares, 1, 0.25);
}

TEST(Rerun, SaysNothingOfModelsThatAreAlike) {
  const Rerun rerun = compare_forecasts(pass_with(0.1, 1), pass_with(0.1, 1));
  EXPECT_FALSE(rerun.confirms());
  EXPECT_FALSE(rerun.refutes());
}

}  // namespace
}  // namespace traceraft
