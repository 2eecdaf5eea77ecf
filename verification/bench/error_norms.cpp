#include "verification/bench/error_norms.hpp"

#include <cmath>

#include "kernel/fem/density_load.hpp"
#include "verification/bench/surface_gradients.hpp"

namespace traceraft::bench {

ErrorNorms error_norms(const fem::SurfaceSpace& space, VecView nodal, const ExactFunction& exact) {
  const Vec values = fem::trace(space, nodal);
  const std::vector<Point> gradients = surface_gradients(space, nodal);
  double l2 = 0, h1 = 0;
  for (std::size_t k = 0; k < space.surface.triangles.size(); ++k) {
    const auto& corner = space.surface.triangles[k];
    const double area = space.surface.triangle_area[k];
    const Point normal =
        mesh::cut_normal(space.mesh, space.mesh.tets[space.surface.triangle_tet[k]]);
    for (std::size_t p = 0; p < fem::kDegreeFourRule.size(); ++p) {
      const auto& [at, weight] = fem::kDegreeFourRule[p];
      const Point point = fem::quadrature_point(space.surface, k, p).x;
      double value = 0;
      for (int v = 0; v < 3; ++v) value += at[v] * values[corner[v]];
      const double difference = value - exact.value(point);
      Point slope = gradients[k] - exact.gradient(point);
      slope -= slope.dot(normal) * normal;
      l2 += weight * area * difference * difference;
      h1 += weight * area * slope.squaredNorm();
    }
  }
  return {std::sqrt(l2), std::sqrt(h1)};
}

}  // namespace traceraft::bench
