// The stiffness of measured fields.
#pragma once

#include "kernel/fem/sparse_view.hpp"

namespace traceraft {

// Of fields that are constant along normals, since nothing is known off the surface: with the
// largest weight of S that keeps the order.
inline EigenMatrix stiffness_along_normals(const SurfaceSpace& space) {
  return as_eigen(space, combine(1, space.stiffness, 1 / space.h(), space.normal_stiffness));
}

}  // namespace traceraft
