// Where the search for D begins.
#pragma once

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft {

// The model, at the pace 1 with its own effects, with another one: that of the data if nothing else
// is missing, to 2 % or so, from a filter of a few directions. Where it is far from the data as it
// is, but not without its effects, their strengths are 0.
FilterModel with_first_pace(const FilterProblems& data, const FilterModel& model,
                            const FilterSettings& settings);

}  // namespace traceraft
