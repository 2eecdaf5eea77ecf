// Lines through measured points, and how far to trust them.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace traceraft {

using Points = std::vector<std::pair<double, double>>;

// 95 % of normally distributed values are within so many standard deviations.
inline constexpr double kNormal95 = 1.96;

// A stretch of times, both ends included.
struct Window {
  double begin, end;
  bool contains(double t) const { return t >= begin && t <= end; }
};

struct Line {
  double slope, intercept;
};
// Least squares. At least two different x.
Line fit_line(const Points& points);
// ln y = slope · ln x + intercept. x, y > 0.
Line fit_power_law(const Points& points);

// y = C (t + offset)^b by least squares of ln y, the offset among 0 and 1000 values between a
// thousandth and ten times the first t: what laws like L³ = L₀³ + K t ask for.
struct ShiftedPowerLaw {
  double exponent, offset;
};
ShiftedPowerLaw fit_shifted_power_law(const Points& points);

// The order p of errors e ~ h^p: between the two finest levels, and how much that differs from the
// order between the two before them (0 if there are no three).
struct ObservedOrder {
  double order, change;
};
ObservedOrder observed_order(const Points& size_and_error);

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
// Of few, the percentiles' interval is too narrow: for a mean of n its variance is (n − 1)/n of
// what it has to be, and the quantile is the normal one instead of Student's. By that factor about
// `centre`, the statistic of all, it is widened.
Interval widened_for_few(const Interval& interval, double centre, int count);
double factor_for_few(int count);
// Student's quantile over the normal one alone: for estimates of which the variance is right on
// average, but known from so many.
double student_factor(int count);

// Of errors, which have to be small: NaN is the largest of all.
double larger(double a, double b);

struct Moments {
  double mean, deviation;  // of the sample, with n − 1
  double low, high;
};
Moments moments(const std::vector<double>& values);

}  // namespace traceraft
