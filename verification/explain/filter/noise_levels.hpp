// How noisy a series of fields is, by what it states of that and by how far it lies from forecasts.
#pragma once

#include "verification/explain/filter/field_filter.hpp"

namespace traceraft {

// Standard deviation of the values that count, in c: their root mean square. Without the first
// snapshots, of whose own noise nothing is known.
double noise_of(const FilterProblems& data);

// Standard deviation of c over all measured values, without the noise.
double contrast_of(const FilterProblems& data);

// The noise that the innovations of a pass have becomes that of the measurements: one for all of a
// vesicle's snapshots, in units of the deviations that they state, but for those that state them
// wrongly.
void fit_noise(FilterProblems& data, const FilterResult& pass);

}  // namespace traceraft
