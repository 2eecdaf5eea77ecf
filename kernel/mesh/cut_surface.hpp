// The discrete surface Γ_h: the zero level of the P1 interpolant of φ, as triangles whose vertices
// lie on edges of the active mesh and are shared between neighbours.
#pragma once

#include <array>
#include <vector>

#include "kernel/mesh/active_mesh.hpp"

namespace traceraft::mesh {

// Where Γ_h cuts one tetrahedron: 3 or 4 local edges, in cyclic order, seen counter-clockwise from
// the positive side. Four of them split into the triangles (0,1,2) and (0,2,3).
struct CutPolygon {
  int count = 0;
  std::array<int, 4> edge{};
};
CutPolygon cut_polygon(const ActiveMesh& mesh, const ActiveTet& tet);

// Where Γ_h cuts an edge: x = (1 − s) x_low + s x_high.
inline double cut_fraction(double phi_low, double phi_high) {
  return phi_low / (phi_low - phi_high);
}

// Unit normal of Γ_h in a tetrahedron, ∇φ_h/|∇φ_h|, pointing to φ > 0.
Point cut_normal(const ActiveMesh& mesh, const ActiveTet& tet);

inline double triangle_area(const Point& a, const Point& b, const Point& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

struct CutPoint {
  int low, high;  // nodes of the edge
  double s;       // x = (1 − s) x_low + s x_high
  double trace(VecView nodal) const { return (1 - s) * nodal[low] + s * nodal[high]; }
};

struct CutSurface {
  std::vector<CutPoint> points;               // in the order of their edges
  std::vector<Point> position;                // of each point
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<int> triangle_tet;              // ascending
  // Areas of the flat triangles as built here, and of their images on Γ in a SurfaceSpace.
  std::vector<double> triangle_area;
};

CutSurface build_cut_surface(const ActiveMesh& mesh);

// Points − edges + triangles of the whole surface; 2 for each sphere, 0 for each torus.
std::int64_t euler_characteristic(const ActiveMesh& mesh, const CutSurface& surface,
                                  const Communicator& ranks = kAlone);

// How well the mesh follows the surface: the smallest, over all nodes, of |Σ A n| / Σ A with the
// areas A and normals n around the node. 1 for a plane; below kCoarsestResolution the surface turns
// by some 90° within one basis function.
inline constexpr double kCoarsestResolution = 0.7;
struct Resolution {
  double worst;
  Point where;
};
Resolution surface_resolution(const ActiveMesh& mesh, const CutSurface& surface,
                              const Communicator& ranks = kAlone);

// Throws InputError naming the place and a number of cells to try if the mesh is too coarse.
void require_resolution(const ActiveMesh& mesh, const CutSurface& surface,
                        const Communicator& ranks = kAlone);

}  // namespace traceraft::mesh
