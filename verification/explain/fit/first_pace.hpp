// Where the search for D begins.
#pragma once

#include "verification/explain/filter/field_filter.hpp"

namespace traceraft {

// D over that of the base model, if nothing else is missing, to 2 % or so: from a filter of a few
// directions.
double first_pace(const FilterProblems& data, const CahnHilliardModel& base,
                  const FilterSettings& settings);

}  // namespace traceraft
