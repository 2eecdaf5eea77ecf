#include "kernel/geometry/differences.hpp"

#include <Eigen/Geometry>

namespace traceraft::geometry {
namespace {

constexpr double kStep = 2e-3;

// Σ over ±a ± b of the product of the signs times φ, over 4.
double mixed_difference(const LevelSet& surface, const Point& x, const Point& a, const Point& b) {
  return (surface.value(x + a + b) - surface.value(x + a - b) - surface.value(x - a + b) +
          surface.value(x - a - b)) /
         4;
}

}  // namespace

LevelSetDerivatives::LevelSetDerivatives(const LevelSet& surface, const Point& x) {
  const double here = surface.value(x);
  for (int i = 0; i < 3; ++i) {
    const Point a = kStep * Point::Unit(i);
    const double far_before = surface.value(x - 2 * a), before = surface.value(x - a),
                 after = surface.value(x + a), far_after = surface.value(x + 2 * a);
    gradient[i] = (8 * (after - before) - (far_after - far_before)) / (12 * kStep);
    hessian(i, i) =
        (16 * (before + after) - (far_before + far_after) - 30 * here) / (12 * kStep * kStep);
    for (int j = 0; j < i; ++j) {
      const Point b = kStep * Point::Unit(j);
      hessian(i, j) = hessian(j, i) = (4 * mixed_difference(surface, x, a, b) -
                                       0.25 * mixed_difference(surface, x, 2 * a, 2 * b)) /
                                      (3 * kStep * kStep);
    }
  }
}

double LevelSetDerivatives::div_normal() const {
  const Point n = normal();
  return (hessian.trace() - n.dot(hessian * n)) / gradient.norm();
}

double LevelSetDerivatives::gaussian_curvature() const {
  Eigen::Matrix3d adjugate;
  for (int i = 0; i < 3; ++i)
    adjugate.row(i) = hessian.col((i + 1) % 3).cross(hessian.col((i + 2) % 3)).transpose();
  const Point n = normal();
  return n.dot(adjugate * n) / gradient.squaredNorm();
}

}  // namespace traceraft::geometry
