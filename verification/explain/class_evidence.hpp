// What tells the members of a class apart: all that was measured, what is held out included.
#pragma once

#include <optional>
#include <vector>

#include "verification/explain/refit.hpp"

namespace traceraft {

bool holds_out(const FilterProblems& data);

// The criterion of each hypothesis, refitted with every snapshot counting and the noise of `data`;
// nothing where a refit fails.
std::vector<std::optional<double>> criteria_of_all(FilterProblems data,
                                                   const CahnHilliardModel& base,
                                                   const std::vector<Refit>& members,
                                                   FilterSettings settings);

// That were measured: first snapshots aside, and what is held out unless it counts.
double count_values(const FilterProblems& data, bool with_held_out);

}  // namespace traceraft
