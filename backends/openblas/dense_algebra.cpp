#include "backends/openblas/dense_algebra.hpp"

#include <cblas.h>

#include <stdexcept>
#include <vector>

extern "C" void dsyevd_(const char* jobz, const char* uplo, const int* n, double* a, const int* lda,
                        double* w, double* work, const int* lwork, int* iwork, const int* liwork,
                        int* info);
extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace traceraft::openblas {
namespace {

// BLAS refuses a leading dimension of 0.
int leading(const Eigen::MatrixXd& X) {
  return static_cast<int>(std::max<Eigen::Index>(1, X.rows()));
}

int rows(const Eigen::MatrixXd& X) {
  return static_cast<int>(X.rows());
}

int columns(const Eigen::MatrixXd& X) {
  return static_cast<int>(X.cols());
}

}  // namespace

Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  eigen_assert(A.cols() == B.rows());
  Eigen::MatrixXd C(A.rows(), B.cols());
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows(A), columns(B), columns(A), 1,
              A.data(), leading(A), B.data(), leading(B), 0, C.data(), leading(C));
  return C;
}

Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  eigen_assert(A.rows() == B.rows());
  Eigen::MatrixXd C(A.cols(), B.cols());
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, columns(A), columns(B), rows(A), 1, A.data(),
              leading(A), B.data(), leading(B), 0, C.data(), leading(C));
  return C;
}

Eigen::MatrixXd gram(const Eigen::MatrixXd& X) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(X.cols(), X.cols());
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, columns(X), rows(X), 1, X.data(), leading(X),
              0, C.data(), leading(C));
  return C;
}

Eigen::MatrixXd divided_by_upper(const Eigen::MatrixXd& X, const Eigen::MatrixXd& R) {
  eigen_assert(X.cols() == R.rows() && R.rows() == R.cols());
  Eigen::MatrixXd quotient = X;
  cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, rows(X),
              columns(X), 1, R.data(), leading(R), quotient.data(), leading(quotient));
  return quotient;
}

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& lower) {
  eigen_assert(lower.rows() == lower.cols());
  Eigen::MatrixXd L = lower;
  const int n = rows(L), most = leading(L);
  int info = 0;
  dpotrf_("L", &n, L.data(), &most, &info);
  if (info != 0) throw std::runtime_error("a dense matrix is not positive definite");
  return L;
}

Eigen::MatrixXd divided_by_factors(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B) {
  eigen_assert(L.rows() == L.cols() && L.cols() == B.rows());
  Eigen::MatrixXd X = B;
  for (const CBLAS_TRANSPOSE side : {CblasNoTrans, CblasTrans})
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, side, CblasNonUnit, rows(X), columns(X), 1,
                L.data(), leading(L), X.data(), leading(X));
  return X;
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& lower) {
  eigen_assert(lower.rows() == lower.cols());
  if (!lower.allFinite()) throw std::runtime_error("eigenvectors of a matrix that is not finite");
  SymmetricEigen result{Eigen::VectorXd(lower.rows()), lower};
  const int n = rows(lower), most = leading(lower), ask = -1;
  double work_size = 0;
  int index_size = 0, info = 0;
  dsyevd_("V", "L", &n, result.vectors.data(), &most, result.values.data(), &work_size, &ask,
          &index_size, &ask, &info);
  const int work_length = static_cast<int>(work_size);
  std::vector<double> work(static_cast<std::size_t>(work_length));
  std::vector<int> index(static_cast<std::size_t>(index_size));
  dsyevd_("V", "L", &n, result.vectors.data(), &most, result.values.data(), work.data(),
          &work_length, index.data(), &index_size, &info);
  if (info != 0) throw std::runtime_error("eigenvectors of a symmetric matrix do not converge");
  return result;
}

}  // namespace traceraft::openblas
