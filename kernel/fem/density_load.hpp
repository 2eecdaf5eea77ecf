// Load vectors of densities on Γ_h.
#pragma once

#include "kernel/fem/trace.hpp"
#include "kernel/fem/triangle_rule.hpp"

namespace traceraft::fem {

// A point of the quadrature on Γ_h.
struct QuadraturePoint {
  std::size_t number;  // triangle · (points per triangle) + point
  Point x;
};

inline QuadraturePoint quadrature_point(const mesh::CutSurface& surface, std::size_t triangle,
                                        std::size_t point) {
  const auto& [i, j, k] = surface.triangles[triangle];
  const auto& at = kDegreeFourRule[point].at;
  return {triangle * kDegreeFourRule.size() + point,
          at[0] * surface.position[i] + at[1] * surface.position[j] + at[2] * surface.position[k]};
}

// r_i += factor · ∫ g φ_i with g(QuadraturePoint).
template <class Density>
void add_density_load(const SurfaceSpace& space, double factor, const Density& g, VecRef r) {
  const mesh::CutSurface& surface = space.surface;
  const Vec load = point_loads(space, [&](int triangle) {
    std::array<double, 3> corner_load{};
    for (std::size_t p = 0; p < kDegreeFourRule.size(); ++p) {
      const auto& [at, weight] = kDegreeFourRule[p];
      const double value = weight * surface.triangle_area[triangle] *
                           g(quadrature_point(surface, static_cast<std::size_t>(triangle), p));
      for (int a = 0; a < 3; ++a) corner_load[a] += value * at[a];
    }
    return corner_load;
  });
  add_trace_transpose(space, factor, load, r);
}

}  // namespace traceraft::fem
