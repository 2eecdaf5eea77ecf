// The gradient of trace finite element functions along Γ_h.
#pragma once

#include "kernel/fem/surface_space.hpp"

namespace traceraft::bench {

// ∇_Γ u_h, which is constant on every triangle.
std::vector<Point> surface_gradients(const fem::SurfaceSpace& space, VecView nodal);

}  // namespace traceraft::bench
