// How far a statistic of a sample is to be trusted: intervals from samples drawn from it.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace traceraft::statistics {

// Samples of 0 … count − 1: each of them once; or as many drawn with replacement, by the random
// numbers from `first` on.
std::vector<int> each_once(std::size_t count);
std::vector<int> resample(int count, std::uint64_t seed, std::uint64_t stream,
                          std::uint64_t first = 0);

// Percentile bootstrap: the interval that holds the share `confidence` of statistic(sample) over
// samples drawn with replacement.
struct Interval {
  double low, high;
  bool contains(double value) const { return value >= low && value <= high; }
};
Interval bootstrap(int count, int replicates, double confidence, std::uint64_t seed,
                   const std::function<double(const std::vector<int>&)>& statistic);
// The same of several statistics at once.
std::vector<Interval> bootstrap_all(
    int count, int replicates, double confidence, std::uint64_t seed,
    const std::function<std::vector<double>(const std::vector<int>&)>& statistics);
// The percentiles' interval of few is too narrow. For a mean of n its variance is (n − 1)/n of what
// it has to be, and the quantile is the normal one instead of Student's. The interval is widened by
// that factor about `centre`, the statistic of all.
Interval widened_for_few(const Interval& interval, double centre, int count);
double factor_for_few(int count);
// Student's quantile over the normal one alone: for estimates of which the variance is right on
// average, but known from so many.
double student_factor(int count);

}  // namespace traceraft::statistics
