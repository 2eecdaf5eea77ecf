// Dynamic scaling: distributions at different times are one if lengths are measured in a typical
// one.
#pragma once

#include <vector>

#include "verification/measure/fit.hpp"

namespace traceraft {

// The share of the whole at or below x, as points with ascending x from 0 to 1 of a curve that is
// straight in between.
using Cumulative = Points;

// Of the radii √(area/π) over their mean.
Cumulative cumulative_radii(const std::vector<double>& areas);
// Of the power S_l, l > 0, over l in units of the median degree; a degree is spread over l ± ½.
Cumulative cumulative_spectrum(const std::vector<double>& power);

// The largest difference of two curves (Kolmogorov, Smirnov), and that of two independent samples
// of one distribution which is exceeded with a probability of 5 %.
double largest_difference(const Cumulative& p, const Cumulative& q);
double critical_difference(std::size_t p_count, std::size_t q_count);

}  // namespace traceraft
