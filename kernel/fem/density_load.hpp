// Load vectors of densities on Γ_h.
#pragma once

#include "kernel/fem/trace.hpp"
#include "kernel/fem/triangle_rule.hpp"

namespace traceraft::fem {

// A point of the quadrature on Γ_h.
struct QuadraturePoint {
  std::size_t number;  // triangle · (points per triangle) + point
  std::size_t triangle;
  std::array<double, 3> at;  // barycentric coordinates in the triangle
  double weight;             // areas sum to that of Γ
  Point x;

  // There, of a function that is linear on the triangle, by its values at the points of Γ_h.
  double value(const mesh::CutSurface& surface, const Vec& point_value) const {
    const auto& [i, j, k] = surface.triangles[triangle];
    return between_corners({point_value[i], point_value[j], point_value[k]}, at);
  }
};

inline constexpr std::size_t kPointsPerTriangle = kDegreeFourRule.size();
inline std::size_t quadrature_points(const mesh::CutSurface& surface) {
  return surface.triangles.size() * kPointsPerTriangle;
}

inline QuadraturePoint quadrature_point(const mesh::CutSurface& surface, std::size_t triangle,
                                        std::size_t point) {
  const auto& [i, j, k] = surface.triangles[triangle];
  const auto& [at, weight] = kDegreeFourRule[point];
  return {triangle * kPointsPerTriangle + point, triangle, at,
          weight * surface.triangle_area[triangle],
          at[0] * surface.position[i] + at[1] * surface.position[j] + at[2] * surface.position[k]};
}

// Calls use(QuadraturePoint) for the points of a triangle, or of all.
template <class Use>
void for_each_quadrature_point(const mesh::CutSurface& surface, std::size_t triangle,
                               const Use& use) {
  for (std::size_t p = 0; p < kPointsPerTriangle; ++p) use(quadrature_point(surface, triangle, p));
}
template <class Use>
void for_each_quadrature_point(const mesh::CutSurface& surface, const Use& use) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for_each_quadrature_point(surface, t, use);
}

// r_i += factor · ∫ g φ_i with g(QuadraturePoint).
template <class Density>
void add_density_load(const SurfaceSpace& space, double factor, const Density& g, VecRef r) {
  const mesh::CutSurface& surface = space.surface;
  const Vec load = point_loads(space, [&](int triangle) {
    std::array<double, 3> corner_load{};
    for_each_quadrature_point(surface, static_cast<std::size_t>(triangle),
                              [&](const QuadraturePoint& point) {
                                const double value = point.weight * g(point);
                                for (int a = 0; a < 3; ++a) corner_load[a] += value * point.at[a];
                              });
    return corner_load;
  });
  add_trace_transpose(space, factor, load, r);
}

}  // namespace traceraft::fem
