// How long a search for what is missing still takes.
#pragma once

#include "drivers/output/time_left.hpp"
#include "verification/selection/search/search_state.hpp"

namespace traceraft::explain {

// The first calibration in this process is the unit: other steps make a similar number of
// forecasts. How many steps follow depends on what is found, so that the range is wide.
class SearchTimeLeft {
 public:
  explicit SearchTimeLeft(int most_effects) : most_effects_(most_effects) {}

  // After each step, or at the start: the state, and the seconds since the search began. Both ends
  // of the range are 0 while it is unknown, and after steps that take no time.
  output::TimeLeft::Range note(const selection::SearchState& state, double seconds);

 private:
  int most_effects_;
  double before_ = 0, calibration_ = 0;
  selection::SearchStep last_ = selection::SearchStep::start;
};

}  // namespace traceraft::explain
