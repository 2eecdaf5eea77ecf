#include "verification/assimilation/fields/outliers.hpp"

#include <algorithm>

namespace traceraft::assimilation {
namespace {

// In robust standard deviations: of a million normally distributed values none is further away.
constexpr double kFar = 6;
// The median of |x| over the standard deviation, for normal distributions.
constexpr double kMedian = 0.6745;
// Less than that share of the furthest may be the furthest's doing.
constexpr double kPulled = 0.5;

double robust_deviation(Vec residual) {
  residual = residual.cwiseAbs();
  const auto middle = residual.begin() + residual.size() / 2;
  std::nth_element(residual.begin(), middle, residual.end());
  return *middle / kMedian;
}

}  // namespace

std::size_t drop_outliers(const Vec& field, double least, FieldSnapshot& snapshot) {
  const Vec distance = (snapshot.values - field).cwiseAbs();
  const Vec residual = distance.cwiseQuotient(snapshot.deviation);
  const double limit = std::max(kFar * robust_deviation(residual), kPulled * residual.maxCoeff());
  std::vector<Eigen::Index> kept;
  std::vector<Point> points;
  for (Eigen::Index i = 0; i < residual.size(); ++i)
    if (residual[i] < limit || distance[i] < least) {
      kept.push_back(i);
      points.push_back(snapshot.points[static_cast<std::size_t>(i)]);
    }
  const std::size_t dropped = snapshot.points.size() - points.size();
  snapshot.points = std::move(points);
  snapshot.values = Vec(snapshot.values(kept));
  snapshot.deviation = Vec(snapshot.deviation(kept));
  return dropped;
}

}  // namespace traceraft::assimilation
