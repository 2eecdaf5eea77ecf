#include "kernel/fem/potential.hpp"

#include <array>

#include "kernel/fem/averaged_potential.hpp"
#include "kernel/fem/trace.hpp"
#include "kernel/fem/weighted_mass.hpp"

namespace traceraft::fem {
namespace {

// Calls use(value at the point, barycentrics, area weight) for every quadrature point of a triangle
// whose corners have the traces given.
template <class Use>
void for_each_point(double area, const std::array<double, 3>& corner, const Use& use) {
  for (const auto& [at, weight] : kDegreeFourRule)
    use(between_corners(corner, at), at, weight * area);
}

void add_nodal_tangent(const SurfaceSpace& space, const physics::DoubleWell& well, double factor,
                       VecView c, CsrMatrix& matrix) {
  for (std::size_t k = 0; k < matrix.values.size(); ++k)
    matrix.values[k] += factor * space.mass.values[k] * well.second(c[matrix.pattern->column[k]]);
}

}  // namespace

void add_potential(const SurfaceSpace& space, const physics::DoubleWell& well, PotentialRule rule,
                   double factor, VecView c, VecRef r) {
  if (rule == PotentialRule::averaged) return averaged_potential::add(space, well, factor, c, r);
  if (rule == PotentialRule::nodal) {
    const Vec derivative = c.unaryExpr([&](double value) { return well.derivative(value); });
    space.mass.multiply_add(factor, derivative, r, *space.team);
    return;
  }
  const Vec point_value = trace(space, c);
  const Vec load = point_loads(space, [&](int triangle) {
    std::array<double, 3> corner_load{};
    for_each_point(space.surface.triangle_area[triangle],
                   corner_values(space, triangle, point_value),
                   [&](double value, const auto& at, double w) {
                     const double density = w * well.derivative(value);
                     for (int k = 0; k < 3; ++k) corner_load[k] += density * at[k];
                   });
    return corner_load;
  });
  add_trace_transpose(space, factor, load, r);
}

void add_potential_tangent(const SurfaceSpace& space, const physics::DoubleWell& well,
                           PotentialRule rule, double factor, VecView c, CsrMatrix& matrix) {
  if (rule == PotentialRule::averaged)
    return averaged_potential::add_tangent(space, well, factor, c, matrix);
  if (rule == PotentialRule::nodal) return add_nodal_tangent(space, well, factor, c, matrix);
  const Vec point_value = trace(space, c);
  add_weighted_mass(
      space, factor,
      [&](int triangle, std::size_t p) {
        return well.second(
            between_corners(corner_values(space, triangle, point_value), kDegreeFourRule[p].at));
      },
      matrix);
}

void add_potential_tangent_product(const SurfaceSpace& space, const physics::DoubleWell& well,
                                   PotentialRule rule, double factor, VecView c, VecView v,
                                   VecRef r) {
  if (rule == PotentialRule::averaged)
    return averaged_potential::add_tangent_product(space, well, factor, c, v, r);
  if (rule == PotentialRule::nodal) {
    const Vec scaled = c.binaryExpr(
        v, [&](double value, double direction) { return well.second(value) * direction; });
    space.mass.multiply_add(factor, scaled, r, *space.team);
    return;
  }
  const Vec point_value = trace(space, c), point_direction = trace(space, v);
  const Vec load = point_loads(space, [&](int triangle) {
    const std::array<double, 3> direction = corner_values(space, triangle, point_direction);
    std::array<double, 3> corner_load{};
    for_each_point(space.surface.triangle_area[triangle],
                   corner_values(space, triangle, point_value),
                   [&](double value, const auto& at, double w) {
                     const double density = w * well.second(value) * between_corners(direction, at);
                     for (int k = 0; k < 3; ++k) corner_load[k] += density * at[k];
                   });
    return corner_load;
  });
  add_trace_transpose(space, factor, load, r);
}

double potential_energy(const SurfaceSpace& space, const physics::DoubleWell& well,
                        PotentialRule rule, VecView c) {
  if (rule == PotentialRule::averaged) return averaged_potential::energy(space, well, c);
  const Vec point_value = trace(space, c);
  const std::vector<double>& area = space.surface.triangle_area;
  const bool alone = space.communicator->size() == 1;
  return space.team->sum(area.size(), [&](std::size_t t, double& total) {
    if (!alone && !space.owns_triangle(t)) return;
    for_each_point(area[t], corner_values(space, static_cast<int>(t), point_value),
                   [&](double value, const auto&, double w) { total += w * well.energy(value); });
  });
}

}  // namespace traceraft::fem
