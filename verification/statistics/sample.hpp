// Summaries of several numbers.
#pragma once

#include <vector>

namespace traceraft::statistics {

// 95 % of normally distributed values are within so many standard deviations.
inline constexpr double kNormal95 = 1.96;

// Quantiles are linear between order statistics.
struct Sample {
  double mean, deviation;  // deviation: with n − 1; 0 of a single number
  double min, q10, q25, median, q75, q90, max;
};
Sample sample_of(const std::vector<double>& values);  // at least one
// The value below which the share is; at least one value.
double quantile(std::vector<double> values, double share);

// The larger one of two errors, which have to be small: NaN is the largest of all.
double larger(double a, double b);

}  // namespace traceraft::statistics
