// What a reader of a verdict should know before believing it.
#pragma once

#include <string>
#include <vector>

#include "verification/explain/explanation.hpp"

namespace traceraft {

// One sentence each; none if there is nothing to say.
std::vector<std::string> remarks(const Explanation& found, const Units& base);

}  // namespace traceraft
