// Once an effect was found: does another set of effects, near that one, explain the data better, or
// as well?
#pragma once

#include "verification/explain/search/search.hpp"

namespace traceraft {

// Beside an effect that was taken, those before it may stand for something else: replaces or drops
// effects of the model as long as that makes it more probable. What explains the data as well
// becomes a rival, beside those that the found one has already.
void improve(Search& search);

}  // namespace traceraft
