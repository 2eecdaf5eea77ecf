#include "verification/bench/error_norms.hpp"

#include <cmath>

#include "kernel/fem/density_load.hpp"
#include "verification/bench/surface_gradients.hpp"

namespace traceraft::bench {

ErrorNorms error_norms(const fem::SurfaceSpace& space, VecView nodal, const ExactFunction& exact) {
  const Vec values = fem::trace(space, nodal);
  const std::vector<Point> gradients = surface_gradients(space, nodal);
  double l2 = 0, h1 = 0;
  fem::for_each_quadrature_point(space.surface, [&](const fem::QuadraturePoint& at) {
    const int tet = space.surface.triangle_tet[at.triangle];
    const Point normal = mesh::cut_normal(space.mesh, space.mesh.tets[tet]);
    const double difference = at.value(space.surface, values) - exact.value(at.x);
    Point slope = gradients[at.triangle] - exact.gradient(at.x);
    slope -= slope.dot(normal) * normal;
    l2 += at.weight * difference * difference;
    h1 += at.weight * slope.squaredNorm();
  });
  return {std::sqrt(l2), std::sqrt(h1)};
}

}  // namespace traceraft::bench
