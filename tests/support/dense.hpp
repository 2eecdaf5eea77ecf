// Matrices of small problems with all their entries.
#pragma once

#include <Eigen/Dense>

#include "kernel/fem/csr.hpp"

namespace traceraft::testing {

inline Eigen::MatrixXd dense(const fem::CsrMatrix& matrix) {
  const fem::SparsityPattern& p = *matrix.pattern;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(p.rows(), p.rows());
  for (int i = 0; i < p.rows(); ++i)
    for (int k = p.row_begin[i]; k < p.row_begin[i + 1]; ++k)
      result(i, p.column[k]) += matrix.values[k];
  return result;
}

}  // namespace traceraft::testing
