// Hypotheses near one that was built effect by effect: what was taken first may stand for
// something that only shows beside what was taken later.
#pragma once

#include <vector>

#include "verification/selection/search/judgement.hpp"

namespace traceraft::selection {

// The neighbours of `fit`'s hypothesis: without each effect that is not twice as certain as the
// criterion asks (one that is may stay: a refit without it would be for nothing), and with each
// effect replaced by those that came near it in its round. `values`: how many have been measured;
// `allowed`: effects that may be taken.
std::vector<assimilation::Hypothesis> neighbours(
    const Refit& fit, const std::vector<Round>& rounds, double values,
    const std::vector<assimilation::Candidate>& allowed);

}  // namespace traceraft::selection
