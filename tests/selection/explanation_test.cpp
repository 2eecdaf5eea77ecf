#include "verification/selection/search/explanation.hpp"

#include <gtest/gtest.h>

#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft::selection {
namespace {

// The second best: not what was found with something more, nor what failed; by what it leaves, and
// of the last round that had another one.
TEST(RunnerUp, IsTheBestThatIsAnother) {
  const auto fit = [](const std::vector<std::string>& effects, double gap, double deviance) {
    Refit result;
    for (const std::string& effect : effects)
      result.hypothesis.parts.push_back({assimilation::find_candidate(effect).value(), {0.0}});
    result.gap = {gap, 2 * gap};
    result.deviance = deviance;
    return result;
  };
  Explanation found;
  found.found = fit({"gravity", "uptake"}, 0.03, 10);
  EXPECT_FALSE(runner_up(found));
  Round first, last;
  first.refits = {fit({"line-tension"}, 0.01, 0)};
  last.refits = {fit({"gravity", "uptake", "cooling"}, 0.02, 1), fit({"gravity"}, 0.045, 2),
                 fit({"cooling"}, 0.05, 3), fit({"gravity", "cooling"}, 0.04, 4)};
  last.moves = {fit({"asymmetry"}, 0.01, 5)};
  last.moves[0].failure = "it did not converge";
  found.rounds = {first, last};
  ASSERT_TRUE(runner_up(found));
  EXPECT_EQ(runner_up(found)->train, 0.04);
  found.rounds[1].refits.resize(1);
  EXPECT_EQ(runner_up(found)->train, 0.01);  // of the first round
  found.rivals = {fit({"cooling"}, 0.06, 11)};
  EXPECT_EQ(runner_up(found)->heldout, 0.12);
}

}  // namespace
}  // namespace traceraft::selection
