// The covariance of noise: how much of it is white, and how much neighbours share over which
// distances.
#pragma once

#include "kernel/core/thread_team.hpp"
#include "verification/assimilation/fields/field_series.hpp"
#include "verification/assimilation/fields/noise_correlation.hpp"
#include "verification/assimilation/filter/noise_blocks.hpp"

namespace traceraft::assimilation {

struct CorrelationFit {
  NoiseCorrelation correlation;  // white, unless it is significantly more probable than that
  double gain = 0;               // 2 ln of the likelihood ratio of the two, to second order
  double variance = 1;           // of the noise, in units of the blocks' deviations
};

// The least gain by which noise counts as correlated.
inline constexpr double kCorrelated = 30;

// Blocks count as independent of each other. The covariance of noise is a sum of Wendland functions
// with supports in equal ratios, from the spacing of the points on, and a nugget; their variances
// are not negative, and those of less than two standard errors are left out. Does not depend on the
// number of threads.
CorrelationFit fit_correlation(const std::vector<NoiseBlock>& blocks, double spacing,
                               const ThreadTeam& team);

// The variance of noise that has this correlation, likewise.
double fit_variance(const std::vector<NoiseBlock>& blocks, const NoiseCorrelation& correlation,
                    const ThreadTeam& team);

}  // namespace traceraft::assimilation
