// Remarks that a reader of a verdict should know before believing it.
#pragma once

#include <string>
#include <vector>

#include "drivers/explain/explain_run.hpp"

namespace traceraft::explain {

// One sentence each; none if there is nothing to say. `base`: of the model that was given.
std::vector<std::string> remarks(const selection::Explanation& found, const physics::Units& base);
// The same, after what is odd about data and model (ExplainSetup::notes).
std::vector<std::string> remarks_on(const selection::Explanation& found, const ExplainSetup& setup);

}  // namespace traceraft::explain
