// Γ over the flat triangles of Γ_h: what their areas and gradients lack to second order.
// Dziuk and Elliott, Finite element methods for surface PDEs, Acta Numerica 22 (2013), section 4.
#pragma once

#include <vector>

#include "kernel/core/thread_team.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::mesh {

// The image of a triangle on Γ. A function u that is linear on the triangle lives there, too.
struct LiftedTriangle {
  double area;
  // ∫ ∇_Γu·∇_Γv over the image = area (∇u)ᵀ inverse_metric ∇v, with the gradients on the triangle.
  // It vanishes along the triangle's normal.
  Eigen::Matrix3d inverse_metric;
};

// Where x, a point near Γ, is lifted to: along ∇φ(x), to φ = 0. `h` is the scale of differences.
Point lifted(const geometry::LevelSet& level_set, const Point& x, double h);

// The image of triangle t. It stays flat where the image is not near it: at an edge of Γ, on a mesh
// that is far too coarse, or where φ is not finite.
LiftedTriangle lifted_triangle(const geometry::LevelSet& level_set, const ActiveMesh& mesh,
                               const CutSurface& surface, std::size_t t);
// Those of all triangles.
std::vector<LiftedTriangle> lifted_triangles(const geometry::LevelSet& level_set,
                                             const ActiveMesh& mesh, const CutSurface& surface,
                                             const ThreadTeam& team);

}  // namespace traceraft::mesh
