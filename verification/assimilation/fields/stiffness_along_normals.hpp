// The stiffness of measured fields.
#pragma once

#include "kernel/fem/sparse_view.hpp"

namespace traceraft::assimilation {

// The stiffness of fields that are constant along normals, since nothing is known off the surface.
// It has the largest weight of S that keeps the order.
inline fem::EigenMatrix stiffness_along_normals(const fem::SurfaceSpace& space) {
  return fem::as_eigen(space,
                       fem::combine(1, space.stiffness, 1 / space.h(), space.normal_stiffness));
}

}  // namespace traceraft::assimilation
