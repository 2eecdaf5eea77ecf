// Products, Cholesky factors and eigenvectors of large dense matrices by OpenBLAS, whose kernels
// use what the processor has (eight times as fast as those of a portable build of Eigen on one with
// AVX-512).
#pragma once

#include <Eigen/Core>

namespace traceraft::openblas {

// A B.
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
// Aᵀ B.
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
// Xᵀ X, its lower half; the upper one is 0.
Eigen::MatrixXd gram(const Eigen::MatrixXd& X);
// X R⁻¹ with the upper triangle of R.
Eigen::MatrixXd divided_by_upper(const Eigen::MatrixXd& X, const Eigen::MatrixXd& R);

// L of A = L Lᵀ, A being given by its lower half; the upper half of L is that of A. Throws
// std::runtime_error if A is not positive definite.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& lower);
// (L Lᵀ)⁻¹ B.
Eigen::MatrixXd divided_by_factors(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B);

struct SymmetricEigen {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // orthonormal
};
// The eigenvalues and eigenvectors of a symmetric matrix given by its lower half. Throws
// std::runtime_error if there is no convergence, as for a matrix that is not finite.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& lower);

}  // namespace traceraft::openblas
