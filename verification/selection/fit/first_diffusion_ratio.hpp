// Where the search for D begins.
#pragma once

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::selection {

// The model, at the diffusion ratio 1 with its own effects, with another one: that of the data if
// nothing else is missing, to 2 % or so, from a filter of a few directions. Where it is far from
// the data as it is, but not without its effects, their strengths are 0.
assimilation::FilterModel with_first_diffusion_ratio(const assimilation::FilterProblems& data,
                                                     const assimilation::FilterModel& model,
                                                     const assimilation::FilterSettings& settings);

}  // namespace traceraft::selection
