// The candidates that are worth a forecast with the model that has them.
#pragma once

#include "verification/selection/fit/score_test.hpp"

namespace traceraft::selection {

// At most `size` of those that gain most to first order, two at least: the others only if they gain
// a quarter of what the best one does, and enough to tell it from nothing, or come within `limit`
// of it, which tells two of them apart; and all that are like the diffusion ratio, of which the
// first order says next to nothing. With the coefficients to start from.
std::vector<assimilation::Hypothesis::Part> shortlist(const Screening& screening, std::size_t size,
                                                      double limit);

}  // namespace traceraft::selection
