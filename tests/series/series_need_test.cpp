#include "verification/series/series_need.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "verification/explain/search/judgement.hpp"

namespace traceraft {
namespace {

constexpr double kSquare = kSeen * kSeen;

// Of f times as many vesicles: what an effect does squared, beyond what another D does.
double square(const SeriesProducts& p, double f) {
  return f * p.ee - std::pow(f * p.ue, 2) / (f * p.uu + p.known);
}

TEST(SeriesNeed, EffectIsSeenAtWhatIsNeeded) {
  const SeriesProducts p{12, 3, 5, 2};
  const double constant = times_needed(p, {1.5, 1.5});
  EXPECT_NEAR(square(p, constant), kSquare * 1.5, 1e-6);
  // Noise that grows with the number of vesicles takes more of them.
  const double growing = times_needed(p, {1, 4.5});
  EXPECT_GT(growing, constant);
  EXPECT_NEAR(square(p, growing), kSquare * (1 + 0.5 * (growing - 1)), 1e-6);
}

TEST(SeriesNeed, NoiseMayGrowAsFast) {
  EXPECT_TRUE(std::isinf(times_needed({12, 0, 5, 2}, {1, 8})));
}

// What another D does as well is not seen by any number, unless D is known.
TEST(SeriesNeed, AnotherDMayDoTheSame) {
  EXPECT_TRUE(std::isinf(times_needed({20, 10, 5, 0.1}, {1, 1})));
  EXPECT_TRUE(std::isfinite(times_needed({20, 10, 5, 1000}, {1, 1})));
}

}  // namespace
}  // namespace traceraft
