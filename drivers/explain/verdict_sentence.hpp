// What a search has found, for people.
#pragma once

#include <string>

#include "verification/explain/search/explanation.hpp"

namespace traceraft {

// In standard deviations: what a reader may rely on.
inline constexpr double kSure = 3;

// Does the fit ask for another D than the model has?
bool changes_pace(const Refit& fit);

std::string verdict_sentence(const Explanation& found);

}  // namespace traceraft
