#include <gtest/gtest.h>

#include "tests/support/small_vesicle.hpp"
#include "verification/selection/fit/first_pace.hpp"

namespace traceraft {
namespace {

// Whoever mistakes milliseconds for seconds is off by a factor of a thousand, and who mistakes
// minutes for them by sixty.
TEST(FirstPace, IsFoundFromFarAway) {
  BlindRequest asked = testing::small_vesicle(4);
  asked.effects.clear();
  CahnHilliardModel base = asked.base;
  const BlindCase drawn = draw_blind_case(asked);
  FilterSettings few;
  few.rank = 40;
  few.replicates = 0;
  for (const double factor : {1e-3, 400.0}) {
    std::vector<FieldSeries> vesicles = drawn.vesicles;
    for (FieldSnapshot& snapshot : vesicles[0].snapshots) snapshot.time *= factor;
    const FilterProblems data =
        make_filter_problems(vesicles, *make_surface("sphere"), base, 10, 2, true, few);
    const FilterModel found = with_first_pace(data, {base, 1, {}, {}}, few);
    EXPECT_NEAR(std::log(found.pace * factor), 0, 0.2) << factor;
  }
}

}  // namespace
}  // namespace traceraft
