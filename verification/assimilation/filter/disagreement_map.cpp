#include "verification/assimilation/filter/disagreement_map.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::assimilation {
namespace {

constexpr double kReach = 3;  // of the weights, in lengths
constexpr double kFewestPoints = 5;

// A row per place: the weights of the points near it.
PointTrace weights(const std::vector<Point>& places, const std::vector<Point>& points,
                   double length) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < places.size(); ++v)
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double distance = (points[i] - places[v]).norm() / length;
      if (distance < kReach)
        entries.emplace_back(static_cast<int>(v), static_cast<int>(i),
                             std::exp(-0.5 * distance * distance));
    }
  PointTrace W(static_cast<Eigen::Index>(places.size()), static_cast<Eigen::Index>(points.size()));
  W.setFromTriplets(entries.begin(), entries.end());
  for (Eigen::Index v = 0; v < W.rows(); ++v)
    if (W.row(v).sum() < kFewestPoints) W.row(v) *= 0;
  return W;
}

// The limit that nineteen of twenty values do not surpass.
double common_limit(Vec values) {
  const auto at = values.begin() + 19 * values.size() / 20;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

DisagreementMaps disagreement_maps(const FilterProblems& data, const FilterResult& result,
                                   const std::vector<Point>& places, double length) {
  DisagreementMaps maps;
  Vec highest;
  for (const Innovation& in : result.innovations) {
    const FieldSnapshot& snapshot = data[in.vesicle].series.snapshots[in.snapshot];
    const PointTrace W = weights(places, snapshot.points, length);
    const Columns noise = W * gaps_of_replicates(in);
    const Vec variance = noise.rowwise().squaredNorm() / static_cast<double>(noise.cols());
    const Vec inverse = (variance.array() > 0).select(variance.array().rsqrt(), 0.0);
    maps.snapshots.push_back({in.vesicle, snapshot.time, inverse.cwiseProduct(W * in.gap)});
    const Vec extreme = (inverse.asDiagonal() * noise).cwiseAbs().colwise().maxCoeff().transpose();
    highest = highest.size() > 0 ? Vec(highest.cwiseMax(extreme)) : extreme;
  }
  maps.threshold = common_limit(highest);
  return maps;
}

}  // namespace traceraft::assimilation
