#include "verification/measure/dynamic_scaling.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/types.hpp"
#include "verification/measure/spherical_spectrum.hpp"

namespace traceraft {
namespace {

double value_at(const Cumulative& curve, double x) {
  if (x <= curve.front().first) return curve.front().second;
  if (x >= curve.back().first) return curve.back().second;
  const auto right = std::upper_bound(
      curve.begin(), curve.end(), x, [](double at, const auto& point) { return at < point.first; });
  const auto left = right - 1;
  const double share = (x - left->first) / (right->first - left->first);
  return left->second + share * (right->second - left->second);
}

}  // namespace

Cumulative cumulative_radii(const std::vector<double>& areas) {
  std::vector<double> radii;
  double mean = 0;
  const double count = static_cast<double>(areas.size());
  for (const double area : areas) {
    radii.push_back(std::sqrt(area / kPi));
    mean += radii.back() / count;
  }
  std::sort(radii.begin(), radii.end());
  Cumulative curve = {{0, 0}};
  for (std::size_t k = 0; k < radii.size(); ++k)
    curve.emplace_back(radii[k] / mean, static_cast<double>(k + 1) / count);
  return curve;
}

Cumulative cumulative_spectrum(const std::vector<double>& power) {
  const double median = median_degree(power);
  double total = 0, sum = 0;
  for (std::size_t l = 1; l < power.size(); ++l) total += power[l];
  Cumulative curve = {{0.5 / median, 0}};
  for (std::size_t l = 1; l < power.size(); ++l) {
    sum += power[l];
    curve.emplace_back((static_cast<double>(l) + 0.5) / median, sum / total);
  }
  return curve;
}

double largest_difference(const Cumulative& p, const Cumulative& q) {
  double largest = 0;
  for (const Cumulative* curve : {&p, &q})
    for (const auto& [x, share] : *curve)
      largest = std::max(largest, std::fabs(value_at(p, x) - value_at(q, x)));
  return largest;
}

double critical_difference(std::size_t p_count, std::size_t q_count) {
  const double p = static_cast<double>(p_count), q = static_cast<double>(q_count);
  return 1.358 * std::sqrt((p + q) / (p * q));
}

}  // namespace traceraft
