// Cholesky factors in double precision of matrices that come from statistics: precisions of fields,
// covariances of noise.
#pragma once

#include <Eigen/Sparse>
#include <memory>

namespace traceraft::suitesparse {

// By CHOLMOD's supernodes, as the factors of such precisions fill. Not for several threads at once.
class SparseCholesky {
 public:
  SparseCholesky();
  explicit SparseCholesky(const Eigen::SparseMatrix<double>& A) : SparseCholesky() { factorise(A); }
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  // A: n × n, symmetric, compressed, all entries stored; ordered once, so that all matrices have
  // the pattern of the first. Throws std::runtime_error if it is not positive definite.
  void factorise(const Eigen::SparseMatrix<double>& A);

  // A⁻¹ B. Of factors that there are, as below.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  // R Z with R Rᵀ = A⁻¹: of independent normal numbers, columns with the covariance A⁻¹.
  Eigen::MatrixXd correlated(const Eigen::MatrixXd& Z) const;
  // L⁻¹ Z with A = L Lᵀ: columns with the covariance A become independent numbers of variance 1.
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& Z) const;
  // L Z, the inverse of that.
  Eigen::MatrixXd coloured(const Eigen::MatrixXd& Z) const;
  double log_determinant() const;  // of A

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace traceraft::suitesparse
