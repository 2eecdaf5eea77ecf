#include "verification/selection/series/series_candidate.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::selection {
namespace {

// The level before an amplitude > 1, and how far it is on the way to the next one.
struct BetweenLevels {
  std::size_t before;
  double share;
};
BetweenLevels between(double amplitude, std::size_t levels) {
  const auto before = std::min(static_cast<std::size_t>(amplitude) - 1, levels - 2);
  return {before, amplitude - static_cast<double>(before + 1)};
}

}  // namespace

double SeriesCandidate::strength_at(double amplitude) const {
  if (has_one_level() || amplitude <= 1) return amplitude * levels.front().strength;
  const auto [before, share] = between(amplitude, levels.size());
  return levels[before].strength *
         std::pow(levels[before + 1].strength / levels[before].strength, share);
}

double SeriesCandidate::slope_at(double amplitude) const {
  if (has_one_level() || amplitude <= 1) return levels.front().strength;
  const std::size_t before = between(amplitude, levels.size()).before;
  return strength_at(amplitude) * std::log(levels[before + 1].strength / levels[before].strength);
}

// The rate is r = s(a)/u, and dr = (s' da − s d ln u)/u.
double SeriesCandidate::deviation(const likelihood::EnsembleFit& fit) const {
  const double slope = slope_at(fit.amplitude);
  if (!rate) return std::fabs(slope) * fit.deviation;
  const Eigen::Vector2d by(-strength_at(fit.amplitude), slope);  // ln u, a
  return std::sqrt(std::max(0.0, by.dot(fit.covariance * by)));
}

}  // namespace traceraft::selection
