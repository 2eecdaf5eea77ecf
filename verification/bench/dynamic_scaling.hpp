// Dynamic scaling: distributions at different times are one if lengths are measured in a typical
// one.
#pragma once

#include <vector>

#include "verification/statistics/power_law.hpp"

namespace traceraft::bench {

// The share of the whole at or below x, as points with ascending x from 0 to 1 of a curve that is
// straight in between.
using Cumulative = statistics::Points;

// The distribution of the radii √(area/π) over their mean.
Cumulative cumulative_radii(const std::vector<double>& areas);
// The distribution of the power S_l, l > 0, over l in units of the median degree. A degree is
// spread over l ± ½.
Cumulative cumulative_spectrum(const std::vector<double>& power);

// The largest difference of two curves (Kolmogorov, Smirnov).
double largest_difference(const Cumulative& p, const Cumulative& q);
// The limit that the largest difference of cumulative_radii, of all members' areas together,
// surpasses with a probability of 5 % if both times have one distribution. It is taken over all
// ways to exchange the times of some members, as the rafts of one are not independent. At most 16
// members.
double chance_difference(const std::vector<std::vector<double>>& early,
                         const std::vector<std::vector<double>>& late);

}  // namespace traceraft::bench
