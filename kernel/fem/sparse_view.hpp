// A matrix of one rank as Eigen sees it: for factorisations.
#pragma once

#include <Eigen/Sparse>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::fem {

using EigenMatrix = Eigen::SparseMatrix<double>;

inline EigenMatrix as_eigen(const SurfaceSpace& space, const CsrMatrix& A) {
  return Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      space.nodes(), space.nodes(), space.pattern->entries(), space.pattern->row_begin.data(),
      space.pattern->column.data(), A.values.data());
}

}  // namespace traceraft::fem
