#include "verification/recovered_energy.hpp"

#include <stdexcept>

#include "kernel/fem/trace.hpp"

namespace traceraft {
namespace {

// ∇_Γ c_h, constant on every triangle.
std::vector<Point> surface_gradients(const SurfaceSpace& space, ConstVec c) {
  std::vector<Point> gradients;
  for (const int tet_number : space.surface.triangle_tet) {
    const ActiveTet& tet = space.mesh.tets[tet_number];
    const auto basis = scaled_gradients(tet.kuhn);
    Point gradient = Point::Zero();
    for (int i = 0; i < 4; ++i) gradient += c[tet.node[i]] / space.h() * basis.row(i).transpose();
    const Point normal = cut_normal(space.mesh, tet);
    gradients.push_back(gradient - gradient.dot(normal) * normal);
  }
  return gradients;
}

}  // namespace

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
  return potential_energy(space, problem.model().well, c) +
         0.5 * e2 * (space.quadratic(space.stiffness, c) - gradient_error_squared(space, c));
}

}  // namespace traceraft
