// One round of the search: what the model leaves, what that is most like, and whether it is taken.
#pragma once

#include "verification/explain/search/search.hpp"

namespace traceraft {

// Looks for one effect more than the model has. Returns whether there may be another one. Throws
// std::runtime_error if the base model cannot be advanced; where a later one cannot, the search has
// stopped.
bool look_for_one(Search& search);

}  // namespace traceraft
