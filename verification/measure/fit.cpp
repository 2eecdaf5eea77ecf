#include "verification/measure/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "kernel/core/random.hpp"

namespace traceraft {

Line fit_line(const Points& points) {
  const double count = static_cast<double>(points.size());
  double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
  for (const auto& [x, y] : points) {
    x_mean += x / count;
    y_mean += y / count;
  }
  for (const auto& [x, y] : points) {
    xx += (x - x_mean) * (x - x_mean);
    xy += (x - x_mean) * (y - y_mean);
  }
  if (!(xx > 0)) throw std::runtime_error("a line needs two different points");
  return {xy / xx, y_mean - xy / xx * x_mean};
}

Line fit_power_law(const Points& points) {
  Points logarithms;
  for (const auto& [x, y] : points) logarithms.emplace_back(std::log(x), std::log(y));
  return fit_line(logarithms);
}

ShiftedPowerLaw fit_shifted_power_law(const Points& points) {
  ShiftedPowerLaw best{0, 0};
  double least = std::numeric_limits<double>::infinity();
  constexpr int kOffsets = 1000;
  for (int k = 0; k <= kOffsets; ++k) {
    const double offset =
        k == 0 ? 0 : points.front().first * std::pow(10.0, 4.0 * k / kOffsets - 3);
    Points logarithms;
    for (const auto& [t, y] : points) logarithms.emplace_back(std::log(t + offset), std::log(y));
    const Line line = fit_line(logarithms);
    double squares = 0;
    for (const auto& [x, y] : logarithms)
      squares += std::pow(y - line.intercept - line.slope * x, 2);
    if (squares < least) {
      least = squares;
      best = {line.slope, offset};
    }
  }
  return best;
}

ObservedOrder observed_order(const Points& levels) {
  const auto between = [&](std::size_t fine) {
    const auto& [coarse_size, coarse_error] = levels[fine - 1];
    return std::log(coarse_error / levels[fine].second) /
           std::log(coarse_size / levels[fine].first);
  };
  const std::size_t last = levels.size() - 1;
  const double order = between(last);
  return {order, levels.size() > 2 ? std::fabs(order - between(last - 1)) : 0};
}

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
    const std::vector<double> drawn = statistics(resample(count, seed, 91, first));
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

double larger(double a, double b) {
  return std::isnan(a) || b <= a ? a : b;
}

Moments moments(const std::vector<double>& values) {
  const double count = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {mean, std::sqrt(squares / std::max(1.0, count - 1)), *low, *high};
}

}  // namespace traceraft
