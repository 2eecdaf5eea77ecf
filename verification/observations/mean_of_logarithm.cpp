#include "verification/observations/mean_of_logarithm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "verification/statistics/interpolation.hpp"

namespace traceraft::observations {
namespace {

// Tables are in s/(1 + s), up to that of the largest s, as which larger ones are taken.
constexpr int kSteps = 400, kCountSteps = 100;
constexpr double kLargest = 1000, kMostShare = kLargest / (1 + kLargest);
constexpr double kLeastAbsolute = 1e-6;  // of 1 − power
constexpr double kSmall = 0.05;          // s below which moments of z give the mean to 1e-9
constexpr double kTail = 8;              // of a normal distribution
// Counts of which the mean is known, for so many powers, closer to each other near 1.
constexpr int kMany = 32, kPowers = 10;

double normal_above(double z) {
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

double share_of(double s) {
  const double within = std::min(s, kLargest);
  return std::min(within / (1 + within) / kMostShare, 1.0);
}

double at_share(double share) {
  return kMostShare * share / (1 - kMostShare * share);
}

// The mean of ln (1 + s z), by the midpoint rule in u with 1 + s z = u², as ln has a pole at 0.
double integrated_mean(double s) {
  constexpr int kPoints = 1000;
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

// The means of ln (1 + s z) beside ln(1 + s), which they go with where s is large.
std::vector<double> table_of_means() {
  std::vector<double> table{0};
  for (int k = 1; k <= kSteps; ++k) {
    const double s = at_share(static_cast<double>(k) / kSteps);
    table.push_back(integrated_mean(s) - std::log1p(s));
  }
  return table;
}

// The distribution of v = n (1 + a s z)^(1/a).
class Scattered {
 public:
  Scattered(double n, double s, double power)
      : relative_(is_relative(power)),
        ln_n_(std::log(n)),
        s_(s),
        a_(1 - power),
        positive_(relative_ ? 1 : normal_above(-1 / (a_ * s_))) {}

  double above(double v) const {
    const double y = std::log(v) - ln_n_;
    return normal_above((relative_ ? y : std::expm1(a_ * y) / a_) / s_) / positive_;
  }
  double ln_end() const {
    return ln_n_ + (relative_ ? kTail * s_ : std::log1p(kTail * a_ * s_) / a_);
  }

 private:
  bool relative_;
  double ln_n_, s_, a_;
  double positive_;  // share of normal z
};

// Σ ln(k/(k − 1)) P(v > k − ½), k = 2, 3, ..., which is ∫ P(v > x) dx/x where k is large.
double summed_count_mean(int n, double s, double power) {
  constexpr int kPoints = 64, kWhole = 2 * kMany;
  const Scattered v(n, s, power);
  double mean = 0;
  for (int k = 2; k <= kWhole && std::log(k - 0.5) < v.ln_end(); ++k)
    mean += std::log(k / (k - 1.0)) * v.above(k - 0.5);
  const double from = std::log(kWhole), step = std::max(v.ln_end() - from, 0.0) / kPoints;
  for (int i = 0; i < kPoints && step > 0; ++i)
    mean += step * v.above(std::exp(from + (i + 0.5) * step));
  return mean - std::log(n);
}

// The excess of the mean of counts over that of other numbers, divided by 1 + s; for each power and
// for n = 1, 2, ..., kMany.
using CountTable = std::array<std::vector<std::vector<double>>, kPowers + 1>;

CountTable table_of_counts() {
  CountTable table;
  for (int b = 0; b <= kPowers; ++b) {
    const double away = 1 - static_cast<double>(b) / kPowers, power = 1 - away * away;
    for (int n = 1; n <= kMany; ++n) {
      std::vector<double> row{0};
      for (int k = 1; k <= kCountSteps; ++k) {
        const double s = at_share(static_cast<double>(k) / kCountSteps);
        row.push_back((summed_count_mean(n, s, power) - mean_of_logarithm(s, power)) / (1 + s));
      }
      table[static_cast<std::size_t>(b)].push_back(std::move(row));
    }
  }
  return table;
}

double between(double share, double from, double to) {
  return from + share * (to - from);
}

// The entry of the table for n from 1 to kMany.
double from_table(double n, double share, double power) {
  static const CountTable table = table_of_counts();
  const auto row = std::min(static_cast<std::size_t>(n), static_cast<std::size_t>(kMany) - 1) - 1;
  const auto of_power = [&](std::size_t b) {
    return between(n - static_cast<double>(row + 1), statistics::interpolated(table[b][row], share),
                   statistics::interpolated(table[b][row + 1], share));
  };
  const double at = kPowers * (1 - std::sqrt(1 - power));
  const auto b = std::min(static_cast<std::size_t>(at), std::size_t{kPowers - 1});
  return between(at - static_cast<double>(b), of_power(b), of_power(b + 1));
}

}  // namespace

bool is_relative(double power) {
  return 1 - power < kLeastAbsolute;
}

double mean_of_logarithm(double s, double power) {
  static const std::vector<double> table = table_of_means();
  if (is_relative(power)) return 0;
  const double absolute = 1 - power;
  const double within = std::min(absolute * s, kLargest);
  if (within < kSmall) {
    const double square = within * within;
    return -square * (0.5 + square * (0.75 + 2.5 * square)) / absolute;
  }
  return (std::log1p(within) + statistics::interpolated(table, kSteps * share_of(within))) /
         absolute;
}

double mean_of_count_logarithm(double n, double s, double power) {
  const double within = std::min(s, kLargest), most = kMany;
  const double beside =
      (1 + within) * from_table(std::clamp(n, 1.0, most), kCountSteps * share_of(within), power);
  // Rounding, and the limit of 1, matter the less the larger the count is.
  return mean_of_logarithm(s, power) + beside * std::min(most / n, 1.0);
}

}  // namespace traceraft::observations
