#include "verification/error_norms.hpp"

#include <cmath>

#include "kernel/fem/trace.hpp"
#include "kernel/fem/triangle_rule.hpp"

namespace traceraft {

ErrorNorms error_norms(const SurfaceSpace& space, ConstVec nodal, const ExactFunction& exact) {
  const Vec values = trace(space, nodal);
  double l2 = 0, h1 = 0;
  for (std::size_t k = 0; k < space.surface.triangles.size(); ++k) {
    const auto& corner = space.surface.triangles[k];
    const ActiveTet& tet = space.mesh.tets[space.surface.triangle_tet[k]];
    std::array<Point, 3> x;
    for (int v = 0; v < 3; ++v) x[v] = space.surface.position[corner[v]];
    const double area = space.surface.triangle_area[k];
    const Point normal = cut_normal(space.mesh, tet);
    const auto gradients = scaled_gradients(tet.kuhn);
    Point gradient = Point::Zero();
    for (int i = 0; i < 4; ++i)
      gradient += nodal[tet.node[i]] / space.h() * gradients.row(i).transpose();
    for (const auto& [at, weight] : kDegreeFourRule) {
      Point point = Point::Zero();
      double value = 0;
      for (int v = 0; v < 3; ++v) {
        point += at[v] * x[v];
        value += at[v] * values[corner[v]];
      }
      const double difference = value - exact.value(point);
      Point slope = gradient - exact.gradient(point);
      slope -= slope.dot(normal) * normal;
      l2 += weight * area * difference * difference;
      h1 += weight * area * slope.squaredNorm();
    }
  }
  return {std::sqrt(l2), std::sqrt(h1)};
}

}  // namespace traceraft
