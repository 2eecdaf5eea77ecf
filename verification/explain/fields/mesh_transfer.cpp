#include "verification/explain/fields/mesh_transfer.hpp"

#include "kernel/fem/density_load.hpp"

namespace traceraft {
namespace {

// To the values at the quadrature points, triangle after triangle.
PointTrace quadrature_trace(const SurfaceSpace& space) {
  const CutSurface& surface = space.surface;
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0;
  for (const auto& triangle : surface.triangles)
    for (const auto& point : kDegreeFourRule) {
      for (int k = 0; k < 3; ++k) {
        const CutPoint& cut = surface.points[triangle[k]];
        entries.emplace_back(row, cut.low, point.at[k] * (1 - cut.s));
        entries.emplace_back(row, cut.high, point.at[k] * cut.s);
      }
      ++row;
    }
  PointTrace trace(row, space.nodes());
  trace.setFromTriplets(entries.begin(), entries.end());
  return trace;
}

}  // namespace

MeshTransfer::MeshTransfer(const SurfaceSpace& from, SpacePtr to) : to_(std::move(to)) {
  const CutSurface& surface = to_->surface;
  std::vector<Point> places;
  Vec weights(static_cast<Eigen::Index>(surface.triangles.size() * kDegreeFourRule.size()));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t p = 0; p < kDegreeFourRule.size(); ++p) {
      weights[static_cast<Eigen::Index>(places.size())] =
          kDegreeFourRule[p].weight * surface.triangle_area[t];
      places.push_back(quadrature_point(surface, t, p).x);
    }
  const double reach = from.h() + to_->h();
  load_ =
      quadrature_trace(*to_).transpose() * weights.asDiagonal() * point_trace(from, places, reach);
}

Vec MeshTransfer::operator()(ConstVec c) const {
  Vec projected(to_->nodes());
  require(to_->solve_mass(load_ * c, projected));
  return projected;
}

}  // namespace traceraft
