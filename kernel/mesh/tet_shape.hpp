// The shape of a tetrahedron whose vertices are lattice points: all but its place.
#pragma once

#include <array>

#include "kernel/mesh/cube_mesh.hpp"

namespace traceraft::mesh {

// In units of the lattice spacing h, from integers and therefore exact.
struct TetShape {
  Eigen::Matrix<double, 4, 3> gradients;  // row i is h ∇λ_i
  double six_volumes;                     // 6 |T| / h³; 1 for the Kuhn tetrahedra of a cell
  double size;                            // its cube root: h_T / h
  bool left_handed;                       // in the order of its vertices
};

TetShape tet_shape(const std::array<Lattice, 4>& vertex);

}  // namespace traceraft::mesh
