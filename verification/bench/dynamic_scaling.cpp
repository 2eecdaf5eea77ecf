#include "verification/bench/dynamic_scaling.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/types.hpp"
#include "verification/bench/spherical_spectrum.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::bench {
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

using AreasOfMembers = std::vector<std::vector<double>>;

// The areas, in units of the square of the mean √area of all members together.
AreasOfMembers in_units_of_their_mean(AreasOfMembers areas) {
  double sum = 0, count = 0;
  for (const std::vector<double>& own : areas)
    for (const double area : own) {
      sum += std::sqrt(area);
      ++count;
    }
  for (std::vector<double>& own : areas)
    for (double& area : own) area *= count * count / (sum * sum);
  return areas;
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
      largest = statistics::larger(largest, std::fabs(value_at(p, x) - value_at(q, x)));
  return largest;
}

double chance_difference(const AreasOfMembers& early_areas, const AreasOfMembers& late_areas) {
  const std::size_t n = early_areas.size();
  if (n < 2 || n > 16 || late_areas.size() != n)
    throw std::invalid_argument("chance_difference: 2 to 16 members at both times");
  const auto early = in_units_of_their_mean(early_areas), late = in_units_of_their_mean(late_areas);
  std::vector<double> differences;
  // The last one stays: to exchange all others and this one is the same.
  for (std::size_t exchanged = 0; exchanged < std::size_t{1} << (n - 1); ++exchanged) {
    std::vector<double> first, second;
    for (std::size_t k = 0; k < n; ++k) {
      const bool swap = (exchanged >> k & 1) != 0;
      const auto &a = swap ? late[k] : early[k], &b = swap ? early[k] : late[k];
      first.insert(first.end(), a.begin(), a.end());
      second.insert(second.end(), b.begin(), b.end());
    }
    differences.push_back(largest_difference(cumulative_radii(first), cumulative_radii(second)));
  }
  std::sort(differences.begin(), differences.end());
  return differences[static_cast<std::size_t>(0.95 * static_cast<double>(differences.size() - 1) +
                                              0.5)];
}

}  // namespace traceraft::bench
