// Intervals of what is fitted to measurements, over many sets of them.
#include <gtest/gtest.h>

#include "tests/support/published_facts.hpp"
#include "verification/observations/perimeter_law.hpp"

namespace traceraft::observations {
namespace {

// The 95 % interval of the exponent holds the truth as often as it says. Of 155 sets more than 17
// lie outside with a probability of 8e-4, and if it were 15 % with 91 %.
TEST(Published, IntervalsHoldTheTruth) {
  int held = 0;
  constexpr int kSets = 155;
  for (int seed = 1; seed <= kSets; ++seed) {
    const auto law = fit_measurements(draw_measurements(testing::facts_of_3to1(), seed), {0, 1e9});
    ASSERT_TRUE(law);
    EXPECT_EQ(law->points, 62);
    held += law->b.contains(-0.37);
  }
  EXPECT_GE(held, kSets - 17);
  EXPECT_LT(held, kSets);
}

}  // namespace
}  // namespace traceraft::observations
