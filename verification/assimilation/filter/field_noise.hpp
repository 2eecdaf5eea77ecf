// The noise of measured fields by themselves, before any model is held against them.
#pragma once

#include <optional>

#include "verification/assimilation/fields/field_series.hpp"
#include "verification/assimilation/fields/noise_correlation.hpp"

namespace traceraft::assimilation {

struct FieldNoise {
  double level;  // standard deviation in c, root mean square over all values
  NoiseCorrelation correlation;
};

// How values differ from a cubic polynomial in small patches, of which the flatter half counts: far
// from phase boundaries a field is no rougher than that. Nothing if the points are too few.
std::optional<FieldNoise> noise_of_fields(const std::vector<FieldSeries>& series, int threads);

}  // namespace traceraft::assimilation
