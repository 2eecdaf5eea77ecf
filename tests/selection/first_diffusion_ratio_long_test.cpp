#include <gtest/gtest.h>

#include "tests/support/small_vesicle.hpp"
#include "verification/selection/fit/first_diffusion_ratio.hpp"

namespace traceraft::selection {
namespace {

// Whoever mistakes milliseconds for seconds is off by a factor of a thousand, and who mistakes
// minutes for them by sixty.
TEST(FirstDiffusionRatio, IsFoundFromFarAway) {
  BlindRequest asked = testing::small_vesicle(4);
  asked.effects.clear();
  problem::CahnHilliardModel base = asked.base;
  const BlindCase drawn = draw_blind_case(asked);
  assimilation::FilterSettings few;
  few.rank = 40;
  few.replicates = 0;
  for (const double factor : {1e-3, 400.0}) {
    std::vector<assimilation::FieldSeries> vesicles = drawn.vesicles;
    for (assimilation::FieldSnapshot& snapshot : vesicles[0].snapshots) snapshot.time *= factor;
    const assimilation::FilterProblems data = assimilation::make_filter_problems(
        vesicles, geometry::make_surface("sphere"), base, 10, 2, true, few);
    const assimilation::FilterModel found =
        with_first_diffusion_ratio(data, {base, 1, {}, {}}, few);
    EXPECT_NEAR(std::log(found.diffusion_ratio * factor), 0, 0.2) << factor;
  }
}

}  // namespace
}  // namespace traceraft::selection
