// What tells the members of a class apart: all that was measured, what is held out included.
#pragma once

#include <optional>
#include <vector>

#include "verification/explain/refit.hpp"

namespace traceraft {

bool holds_out(const FilterProblems& data);
// With every snapshot counting.
FilterProblems holding_nothing_out(FilterProblems data);

// That were measured and count, first snapshots aside.
double count_values(const FilterProblems& data);

// The criterion of each hypothesis, refitted to the snapshots that count, with the noise of `data`;
// nothing where a refit fails.
std::vector<std::optional<double>> criteria_of(const FilterProblems& data,
                                               const CahnHilliardModel& base,
                                               const std::vector<Refit>& members,
                                               FilterSettings settings);

}  // namespace traceraft
