#include "drivers/explain/search_time_left.hpp"

#include <gtest/gtest.h>

#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft {
namespace {

selection::SearchState before(selection::SearchStep next,
                              const std::vector<std::string>& effects = {}) {
  selection::SearchState state;
  state.next = next;
  for (const std::string& effect : effects)
    state.so_far.found.hypothesis.parts.push_back(
        {assimilation::find_candidate(effect).value(), {0.0}});
  return state;
}

// The seconds at which the steps of a search at 24 cells ended that found exchange, and took 166 s.
TEST(SearchTimeLeft, HoldsWhatASearchTook) {
  constexpr double kWhole = 166;
  explain::SearchTimeLeft left(3);
  (void)left.note(before(selection::SearchStep::start), 4);
  EXPECT_EQ(left.note(before(selection::SearchStep::calibrate), 13).high, 0);
  EXPECT_EQ(left.note(before(selection::SearchStep::screen), 42).high, 0);
  const auto holds = [&](const selection::SearchState& state, double seconds) {
    const output::TimeLeft::Range range = left.note(state, seconds);
    EXPECT_LT(range.low, kWhole - seconds) << seconds;
    EXPECT_GT(range.high, kWhole - seconds) << seconds;
    return range;
  };
  const double first = holds(before(selection::SearchStep::refit), 42).high;
  EXPECT_LT(holds(before(selection::SearchStep::calibrate, {"exchange"}), 86).high, first);
  EXPECT_LT(holds(before(selection::SearchStep::confirm, {"exchange"}), 117).high, 100);
}

// A search that goes on in another process knows its unit only after the next calibration.
TEST(SearchTimeLeft, IsUnknownWithoutACalibration) {
  explain::SearchTimeLeft left(3);
  (void)left.note(before(selection::SearchStep::refit), 0);
  EXPECT_EQ(left.note(before(selection::SearchStep::calibrate, {"exchange"}), 60).high, 0);
  EXPECT_EQ(left.note(before(selection::SearchStep::confirm, {"exchange"}), 90).high, 0);
}

}  // namespace
}  // namespace traceraft
