// Hypotheses near one that was built effect by effect: what was taken first may stand for
// something that only shows beside what was taken later.
#pragma once

#include <vector>

#include "verification/explain/search/judgement.hpp"

namespace traceraft {

// Of a model with `fit`'s hypothesis: without each effect that is no more certain than the
// criterion asks, and with each effect replaced by those that came near it in its round.
// `values`: how many have been measured; `allowed`: effects that may be taken.
std::vector<Hypothesis> neighbours(const Refit& fit, const std::vector<Round>& rounds,
                                   double values, const std::vector<Candidate>& allowed);

}  // namespace traceraft
