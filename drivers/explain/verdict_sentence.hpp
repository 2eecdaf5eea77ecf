// The findings of a search, for people.
#pragma once

#include <string>
#include <vector>

#include "verification/selection/search/explanation.hpp"

namespace traceraft::explain {

// In standard deviations: what a reader may rely on.
inline constexpr double kSure = 3;

// Does the fit ask for another D than the model has?
bool changes_diffusion_ratio(const selection::Refit& fit);

// If the verdict is unnamed: the effects of the model that the search ended with, or the best of
// the single ones, if the data tell it from nothing. "" otherwise.
std::string comes_closest(const selection::Explanation& found);

// "ambiguous (cooling, uptake)": the finding as in the files, and what explains the data.
std::string verdict_words(selection::Finding finding, const std::vector<std::string>& effects);

std::string verdict_sentence(const selection::Explanation& found);

}  // namespace traceraft::explain
