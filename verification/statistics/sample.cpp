#include "verification/statistics/sample.hpp"

#include <algorithm>
#include <cmath>

#include "verification/statistics/interpolation.hpp"

namespace traceraft::statistics {
namespace {

double quantile_of_sorted(const std::vector<double>& values, double share) {
  const double place = share * static_cast<double>(values.size() - 1);
  if (place >= static_cast<double>(values.size() - 1)) return values.back();
  return interpolated(values, place);
}

}  // namespace

Sample sample_of(const std::vector<double>& values) {
  const double count = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) { return quantile_of_sorted(sorted, share); };
  return {mean,     std::sqrt(squares / std::max(1.0, count - 1)),
          at(0),    at(0.1),
          at(0.25), at(0.5),
          at(0.75), at(0.9),
          at(1)};
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return quantile_of_sorted(values, share);
}

double larger(double a, double b) {
  return std::isnan(a) || b <= a ? a : b;
}

}  // namespace traceraft::statistics
