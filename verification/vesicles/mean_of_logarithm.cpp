#include "verification/vesicles/mean_of_logarithm.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "verification/measure/interpolation.hpp"

namespace traceraft {
namespace {

// The table of means, in s/(1 + s) up to that of the largest s, as which larger ones are taken.
constexpr int kSteps = 400;
constexpr double kLargest = 1000, kMostShare = kLargest / (1 + kLargest);
// That of counts, in s; more than that many are like any number.
constexpr int kCountSteps = 400, kMany = 32;
constexpr double kWidest = 4;

double normal_above(double z) {
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

// By the midpoint rule, x = 1 + s z = u², as ln has a pole at 0.
double integrated_mean(double s) {
  constexpr int kPoints = 1000;
  constexpr double kTail = 8;
  const double end = std::sqrt(1 + kTail * s);
  double mean = 0, weights = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double u = end * (i + 0.5) / kPoints, z = (u * u - 1) / s;
    const double weight = u * std::exp(-0.5 * z * z);
    mean += weight * 2 * std::log(u);
    weights += weight;
  }
  return mean / weights;
}

// Σ ln(k/(k − 1)) P(n + s n z > k − ½), k = 2, 3, ..., of positive n + s n z.
double summed_count_mean(int n, double s) {
  constexpr double kTail = 8;
  const double deviation = s * n;
  double mean = 0;
  for (int k = 2; k < n + kTail * deviation + 1; ++k)
    mean += std::log(k / (k - 1.0)) * normal_above((k - 0.5 - n) / deviation);
  return mean / normal_above(-1 / s) - std::log(n);
}

// Mean of ln(1 + s z) beside ln(1 + s), which it goes with where s is large.
std::vector<double> table_of_means() {
  std::vector<double> table{0};
  for (int k = 1; k <= kSteps; ++k) {
    const double share = kMostShare * k / kSteps, s = share / (1 - share);
    table.push_back(integrated_mean(s) - std::log1p(s));
  }
  return table;
}

// Of n = 1, 2, ... and s = 0 to kWidest: what counts have beside other numbers.
std::vector<std::vector<double>> table_of_counts() {
  std::vector<std::vector<double>> table;
  for (int n = 1; n <= kMany; ++n) {
    std::vector<double> row{0};
    for (int k = 1; k <= kCountSteps; ++k) {
      const double s = kWidest * k / kCountSteps;
      row.push_back(summed_count_mean(n, s) - mean_of_logarithm(s));
    }
    table.push_back(std::move(row));
  }
  return table;
}

}  // namespace

double mean_of_logarithm(double s) {
  static const std::vector<double> table = table_of_means();
  const double within = std::min(s, kLargest);
  const double share = within / (1 + within) / kMostShare;
  return std::log1p(within) + interpolated(table, kSteps * std::min(share, 1.0));
}

double mean_of_count_logarithm(double n, double s) {
  static const std::vector<std::vector<double>> table = table_of_counts();
  if (n >= kMany) return mean_of_logarithm(s);
  const double place = kCountSteps * std::min(s / kWidest, 1.0);
  const auto below = static_cast<std::size_t>(std::max(n, 1.0)) - 1;
  const double from = interpolated(table[below], place), to = interpolated(table[below + 1], place);
  const double beside = from + (std::max(n, 1.0) - static_cast<double>(below + 1)) * (to - from);
  // What is whole and what is 1 at least matters the less the wider values scatter.
  return mean_of_logarithm(s) + beside * std::min(kWidest / s, 1.0);
}

}  // namespace traceraft
