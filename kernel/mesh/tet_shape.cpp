#include "kernel/mesh/tet_shape.hpp"

#include <cmath>

namespace traceraft::mesh {

TetShape tet_shape(const std::array<Lattice, 4>& vertex) {
  Eigen::Matrix3d side;  // column i leads from vertex 0 to vertex i + 1
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis)
      side(axis, i) = static_cast<double>(vertex[i + 1][axis] - vertex[0][axis]);
  const double determinant = side.col(0).dot(side.col(1).cross(side.col(2)));
  TetShape shape{};
  for (int i = 0; i < 3; ++i)
    shape.gradients.row(i + 1) = side.col((i + 1) % 3).cross(side.col((i + 2) % 3)) / determinant;
  shape.gradients.row(0) = -shape.gradients.bottomRows<3>().colwise().sum();
  shape.gradients.array() += 0.0;  // no −0
  shape.six_volumes = std::fabs(determinant);
  shape.size = std::cbrt(shape.six_volumes);
  shape.left_handed = determinant < 0;
  return shape;
}

}  // namespace traceraft::mesh
