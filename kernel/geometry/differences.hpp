// Derivatives of a level set at a point, by differences.
#pragma once

#include "kernel/geometry/level_set.hpp"

namespace traceraft::geometry {

// Differences are of fourth order. With steps of 2e-3 R the errors of a smooth level set are 1e-10
// of its size, which is what rounding leaves of second derivatives.
struct LevelSetDerivatives {
  Point gradient;
  Eigen::Matrix3d hessian;

  LevelSetDerivatives(const LevelSet& surface, const Point& x);

  Point normal() const { return gradient.normalized(); }
  // div n, twice the mean curvature: 2 on the unit sphere.
  double div_normal() const;
  // nᵀ adj(∇²φ) n/|∇φ|²: 1 on the unit sphere.
  double gaussian_curvature() const;
};

}  // namespace traceraft::geometry
