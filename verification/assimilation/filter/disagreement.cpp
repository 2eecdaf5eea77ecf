#include "verification/assimilation/filter/disagreement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace traceraft::assimilation {
namespace {

constexpr int kFewestValues = 10;
constexpr std::array<const char*, 3> kStates = {"outside rafts", "boundary", "inside rafts"};

// The middle half of the way from one well to the other counts as the boundary.
std::size_t state_of(double forecast, const physics::DoubleWell& well) {
  const double share = (forecast - well.a) / (well.b - well.a);
  return share < 0.25 ? 0 : share > 0.75 ? 2 : 1;
}

}  // namespace

std::vector<Point> patch_middles() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Point> corners;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g})
      for (int d = 0; d < 3; ++d) {
        Point x = Point::Zero();
        x[d] = s;
        x[(d + 1) % 3] = t;
        corners.push_back(x.normalized());
      }
  return corners;
}

std::size_t nearest_patch(const std::vector<Point>& middles, const Point& x) {
  return static_cast<std::size_t>(
      std::max_element(middles.begin(), middles.end(),
                       [&](const Point& a, const Point& b) { return a.dot(x) < b.dot(x); }) -
      middles.begin());
}

std::vector<Disagreement> disagreements(const FilterProblems& data, const FilterResult& result,
                                        const physics::DoubleWell& well) {
  const std::vector<Point> corners = patch_middles();
  std::vector<Disagreement> all;
  for (const Innovation& in : result.innovations) {
    const FieldSnapshot& snapshot = data[in.vesicle].series.snapshots[in.snapshot];
    const auto patches = static_cast<Eigen::Index>(kStates.size() * corners.size());
    Columns member = Columns::Zero(in.values.size(), patches);
    for (Eigen::Index i = 0; i < in.values.size(); ++i) {
      const Point& x = snapshot.points[static_cast<std::size_t>(i)];
      const std::size_t patch =
          state_of(in.forecast[i], well) * corners.size() + nearest_patch(corners, x);
      member(i, static_cast<Eigen::Index>(patch)) = 1;
    }
    // eᵀ S⁻¹ ν against the same of noise.
    const Columns weighted = InnovationCovariance(in, 0).solve(whitened(in, member));
    const Vec measured = weighted.transpose() * in.values;
    const Columns noise = weighted.transpose() * in.replicates;
    for (Eigen::Index patch = 0; patch < patches; ++patch) {
      if (member.col(patch).sum() < kFewestValues) continue;
      const double z = measured[patch] / std::sqrt(noise.row(patch).squaredNorm() /
                                                   static_cast<double>(noise.cols()));
      const auto index = static_cast<std::size_t>(patch);
      all.push_back({in.vesicle, snapshot.time, kStates[index / corners.size()],
                     corners[index % corners.size()], z, std::erfc(std::fabs(z) / std::sqrt(2.0))});
    }
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.p < b.p; });
  return all;
}

std::size_t significant(const std::vector<Disagreement>& sorted, double level) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k)
    if (sorted[k].p <= level * static_cast<double>(k + 1) / static_cast<double>(sorted.size()))
      count = k + 1;
  return count;
}

}  // namespace traceraft::assimilation
