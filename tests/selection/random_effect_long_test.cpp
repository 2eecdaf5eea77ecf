// A search for an effect that is random: rafts that wander.
#include <gtest/gtest.h>

#include <set>

#include "tests/support/small_vesicle.hpp"
#include "verification/selection/fit/refit.hpp"
#include "verification/selection/search/explanation.hpp"

namespace traceraft::selection {
namespace {

class RandomEffectTest : public ::testing::Test {
 protected:
  static BlindRequest asked(const std::vector<std::string>& hidden) {
    BlindRequest request = testing::searched_vesicle();
    request.effects = hidden;
    return request;
  }
  static Explanation explained(const std::vector<std::string>& hidden) {
    const BlindCase drawn = draw_blind_case(asked(hidden));
    ExplainRequest request;
    request.base = asked({}).base;
    request.surface = geometry::make_surface("sphere");
    request.cells = 15;
    request.filter.replicates = 99;
    const std::set<std::string> some{"brownian-flow", "flow", "gravity", "uptake"};
    for (const assimilation::Candidate& candidate : assimilation::candidates())
      if (some.count(candidate.name) == 0) request.without.push_back(candidate.name);
    return explain_fields(drawn.vesicles, request);
  }
};

TEST_F(RandomEffectTest, IsNamedWithItsStrength) {
  const Explanation found = explained({"brownian-flow"});
  EXPECT_EQ(class_of(found), std::vector<std::string>{"brownian-flow"});
  const double truth = draw_blind_case(asked({"brownian-flow"})).truth.front().values[1];
  ASSERT_EQ(found.found.hypothesis.parts.size(), 1U);
  const double thermal = found.found.hypothesis.parts.front().coefficients.front(),
               deviation = std::sqrt(found.found.covariance(0, 0));
  EXPECT_NEAR(thermal, truth, 2.5 * deviation);
  EXPECT_LT(deviation, 0.5 * thermal);
  EXPECT_GT(found.found.random_gain, 50);
  // No forecast closes the gap; what is to be expected of it grows.
  EXPECT_NEAR(found.found.gap.train / found.base.gap.train, 1, 0.1);
  EXPECT_GT(found.found.random.train, 0.2 * found.found.expected.train);
  EXPECT_GT(shares_closed(found.base, found.found).train.value(), 0.6);
  EXPECT_TRUE(found.rerun->confirms());
}

TEST_F(RandomEffectTest, IsNotFoundWhereNothingIsMissing) {
  const Explanation found = explained({});
  EXPECT_FALSE(is_named(found));
  EXPECT_NE(found.finding, Finding::unnamed);
}

}  // namespace
}  // namespace traceraft::selection
