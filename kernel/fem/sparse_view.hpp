// A matrix of one rank as Eigen sees it: for factorisations.
#pragma once

#include <Eigen/Sparse>

#include "kernel/fem/surface_space.hpp"

namespace traceraft {

using EigenMatrix = Eigen::SparseMatrix<double>;

inline EigenMatrix as_eigen(const SurfaceSpace& space, const CsrMatrix& A) {
  return Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      space.nodes(), space.nodes(), space.pattern->entries(), space.pattern->row_begin.data(),
      space.pattern->column.data(), A.values.data());
}

// Of fields that are constant along normals, since nothing is known off the surface: with the
// largest weight of S that keeps the order.
inline EigenMatrix stiffness_along_normals(const SurfaceSpace& space) {
  return as_eigen(space, combine(1, space.stiffness, 1 / space.h(), space.normal));
}

}  // namespace traceraft
