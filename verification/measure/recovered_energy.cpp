#include "verification/measure/recovered_energy.hpp"

#include <stdexcept>

#include "kernel/fem/trace.hpp"
#include "verification/measure/surface_gradients.hpp"

namespace traceraft {
double gradient_error_squared(const SurfaceSpace& space, ConstVec c) {
  const std::vector<Point> gradients = surface_gradients(space, c);
  double error = 0;
  for (std::size_t t = 0; t < gradients.size(); ++t)
    error += space.surface.triangle_area[t] * gradients[t].squaredNorm();
  for (int k = 0; k < 3; ++k) {
    const Vec load = point_loads(space, [&](int t) {
      const double third = space.surface.triangle_area[t] / 3 * gradients[t][k];
      return std::array<double, 3>{third, third, third};
    });
    Vec b = Vec::Zero(space.nodes()), recovered(space.nodes());
    add_trace_transpose(space, 1, load, b);
    if (const Status status = space.solve_mass(b, recovered); !status.ok())
      throw std::runtime_error("recovered gradient: " + status.why);
    error += space.inner(recovered, recovered) - 2 * b.dot(recovered);
  }
  return error;
}

double recovered_energy(const CahnHilliard& problem, ConstVec c) {
  const SurfaceSpace& space = problem.space();
  const double e2 = problem.model().epsilon * problem.model().epsilon;
  return potential_energy(space, problem.model().well, problem.model().rule, c) +
         0.5 * e2 * (space.quadratic(space.stiffness, c) - gradient_error_squared(space, c));
}

}  // namespace traceraft
