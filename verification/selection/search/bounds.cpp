#include "verification/selection/search/bounds.hpp"

#include <algorithm>
#include <cmath>

#include "verification/statistics/sample.hpp"

namespace traceraft::selection {
namespace {

// 95 % of normally distributed values are below.
constexpr double kOneSided = 1.645;

// Derivatives of the strength by the coefficients.
Vec slopes(const assimilation::Candidate& candidate) {
  Vec slope(candidate.directions);
  for (int d = 0; d < candidate.directions; ++d) {
    std::vector<double> a(static_cast<std::size_t>(candidate.directions), 0.0);
    a[static_cast<std::size_t>(d)] = candidate.step;
    slope[d] = candidate.term(a).values[candidate.parameter] / candidate.step;
  }
  return slope;
}

Bound bound_of(const CandidateScore& score, const assimilation::Candidate& candidate) {
  const Vec slope = slopes(candidate);
  const double value = slope.dot(
      Eigen::Map<const Vec>(score.coefficients.data(), static_cast<Eigen::Index>(slope.size())));
  const double deviation = std::sqrt(slope.dot(score.covariance * slope));
  const double width =
      bound_width(deviation, candidate.directions, candidate.two_sided, score.null_mean);
  const bool seen = (score.covariance.diagonal().array() > 0).all();
  const double low = candidate.two_sided ? std::max(value - width, candidate.least) : 0.0;
  return {score.effect, low, std::min(value + width, candidate.most), seen};
}

}  // namespace

double bound_width(double deviation, int directions, bool two_sided, double null_mean) {
  // Noise gains 1 per coefficient on average, half of it if one sign is excluded.
  const double expected = directions * (two_sided ? 1.0 : 0.5);
  return (two_sided ? statistics::kNormal95 : kOneSided) * deviation *
         std::sqrt(std::max(1.0, null_mean / expected));
}

std::vector<Bound> bounds_of(const Screening& screening,
                             const std::vector<assimilation::Candidate>& screened) {
  std::vector<Bound> bounds;
  for (const assimilation::Candidate& candidate : screened)
    for (const CandidateScore& score : screening.scores)
      if (score.effect == candidate.name) bounds.push_back(bound_of(score, candidate));
  return bounds;
}

}  // namespace traceraft::selection
