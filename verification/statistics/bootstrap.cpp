#include "verification/statistics/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/core/random.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::statistics {

std::vector<int> each_once(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<int> resample(int count, std::uint64_t seed, std::uint64_t stream,
                          std::uint64_t first) {
  std::vector<int> sample;
  for (int k = 0; k < count; ++k)
    sample.push_back(random_index(count, seed, stream, first + static_cast<std::uint64_t>(k)));
  return sample;
}

Interval bootstrap(int count, int replicates, double confidence, std::uint64_t seed,
                   const std::function<double(const std::vector<int>&)>& statistic) {
  return bootstrap_all(
             count, replicates, confidence, seed,
             [&](const std::vector<int>& sample) { return std::vector<double>{statistic(sample)}; })
      .front();
}

std::vector<Interval> bootstrap_all(
    int count, int replicates, double confidence, std::uint64_t seed,
    const std::function<std::vector<double>(const std::vector<int>&)>& statistics) {
  std::vector<std::vector<double>> values;  // of each statistic
  for (int k = 0; k < replicates; ++k) {
    const auto first = static_cast<std::uint64_t>(k) * static_cast<std::uint64_t>(count);
    const std::vector<double> drawn = statistics(resample(count, seed, stream::bootstrap, first));
    values.resize(drawn.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) values[i].push_back(drawn[i]);
  }
  std::vector<Interval> intervals;
  for (std::vector<double>& one : values) {
    std::sort(one.begin(), one.end());
    const auto quantile = [&](double share) {
      return one[static_cast<std::size_t>(share * static_cast<double>(replicates - 1) + 0.5)];
    };
    intervals.push_back({quantile(0.5 * (1 - confidence)), quantile(0.5 * (1 + confidence))});
  }
  return intervals;
}

// Student's 97.5 % over the normal one (Abramowitz, Stegun 26.7.5), to 1 % for three degrees of
// freedom and more.
double student_factor(int count) {
  const double nu = count - 1, z = 1.959964;
  const auto power = [z](int k) { return std::pow(z, k); };
  const double t = z + (power(3) + z) / (4 * nu) +
                   (5 * power(5) + 16 * power(3) + 3 * z) / (96 * nu * nu) +
                   (3 * power(7) + 19 * power(5) + 17 * power(3) - 15 * z) / (384 * nu * nu * nu);
  return t / z;
}

double factor_for_few(int count) {
  return student_factor(count) * std::sqrt(count / (count - 1.0));
}

Interval widened_for_few(const Interval& interval, double centre, int count) {
  const double factor = factor_for_few(count);
  return {centre - factor * (centre - interval.low), centre + factor * (interval.high - centre)};
}

}  // namespace traceraft::statistics
