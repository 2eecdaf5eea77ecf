#include "kernel/mesh/lifted_surface.hpp"

#include <cmath>

namespace traceraft::mesh {
namespace {

using Tangents = Eigen::Matrix<double, 3, 2>;

// From differences along the directions of a tetrahedron's corners: Σ d_k d_kᵀ = 4 I. Its error of
// order `step` varies smoothly, and any smooth direction will do.
Point gradient(const geometry::LevelSet& level_set, const Point& x, double step) {
  static const Point directions[] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  Point sum = Point::Zero();
  for (const Point& d : directions) sum += level_set.value(x + step * d) * d;
  return sum / (4 * step);
}

// How the lift maps lengths in a plane to lengths on Γ, at a point: gᵢⱼ = ∂ᵢy·∂ⱼy.
Eigen::Matrix2d first_form(const geometry::LevelSet& level_set, const Point& x,
                           const Tangents& plane, double h) {
  const double step = 2e-4 * h;
  Tangents slope;
  for (int axis = 0; axis < 2; ++axis) {
    const Point along = step * plane.col(axis);
    slope.col(axis) =
        (lifted(level_set, x + along, h) - lifted(level_set, x - along, h)) / (2 * step);
  }
  return slope.transpose() * slope;
}

}  // namespace

Point lifted(const geometry::LevelSet& level_set, const Point& x, double h) {
  const Point slope = gradient(level_set, x, 1e-4 * h);
  const double steepness = slope.norm();
  const Point direction = slope / steepness;
  double along = -level_set.value(x) / steepness;
  along -= level_set.value(x + along * direction) / steepness;
  return x + along * direction;
}

LiftedTriangle lifted_triangle(const geometry::LevelSet& level_set, const ActiveMesh& mesh,
                               const CutSurface& surface, std::size_t t) {
  const auto corner = [&](int k) { return surface.position[surface.triangles[t][k]]; };
  const Point normal = cut_normal(mesh, mesh.tets[surface.triangle_tet[t]]);
  Tangents plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));
  const LiftedTriangle flat{surface.triangle_area[t], plane * plane.transpose()};
  double stretch = 0;
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  for (int k = 0; k < 3; ++k) {  // the rule of the midpoints of edges, of degree 2
    const Point middle = 0.5 * (corner(k) + corner((k + 1) % 3));
    const Eigen::Matrix2d g = first_form(level_set, middle, plane, mesh.cube.h());
    const double determinant = g.determinant();
    if (!(determinant > 0.25 && determinant < 4)) return flat;
    stretch += std::sqrt(determinant) / 3;
    inverse += std::sqrt(determinant) / 3 * g.inverse();
  }
  return {stretch * flat.area, plane * (inverse / stretch) * plane.transpose()};
}

std::vector<LiftedTriangle> lifted_triangles(const geometry::LevelSet& level_set,
                                             const ActiveMesh& mesh, const CutSurface& surface,
                                             const ThreadTeam& team) {
  std::vector<LiftedTriangle> result(surface.triangles.size());
  team.for_range(result.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      result[t] = lifted_triangle(level_set, mesh, surface, t);
  });
  return result;
}

}  // namespace traceraft::mesh
