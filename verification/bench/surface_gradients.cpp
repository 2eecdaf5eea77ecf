#include "verification/bench/surface_gradients.hpp"

namespace traceraft::bench {

std::vector<Point> surface_gradients(const fem::SurfaceSpace& space, VecView nodal) {
  std::vector<Point> gradients;
  for (const int number : space.surface.triangle_tet) {
    const mesh::ActiveTet& tet = space.mesh.tets[number];
    const auto& basis = space.mesh.shape(tet).gradients;
    Point gradient = Point::Zero();
    for (int i = 0; i < 4; ++i)
      gradient += nodal[tet.node[i]] / space.h() * basis.row(i).transpose();
    const Point normal = mesh::cut_normal(space.mesh, tet);
    gradients.push_back(gradient - gradient.dot(normal) * normal);
  }
  return gradients;
}

}  // namespace traceraft::bench
