// Errors of a trace finite element function against an exact one, integrated over Γ_h.
#pragma once

#include <functional>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::bench {

struct ExactFunction {
  std::function<double(const Point&)> value;    // at points near Γ
  std::function<Point(const Point&)> gradient;  // in R³; only its tangential part is used
};

struct ErrorNorms {
  double l2;  // ‖u_h − u‖ in L²(Γ_h)
  double h1;  // ‖∇_Γ(u_h − u)‖ in L²(Γ_h)
};

ErrorNorms error_norms(const fem::SurfaceSpace& space, VecView nodal, const ExactFunction& exact);

}  // namespace traceraft::bench
