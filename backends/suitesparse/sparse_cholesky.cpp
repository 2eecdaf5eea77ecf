#include "backends/suitesparse/sparse_cholesky.hpp"

#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

#include "backends/suitesparse/blas.hpp"
#include "backends/suitesparse/cholmod_workspace.hpp"

namespace traceraft::suitesparse {

namespace {

// CHOLMOD reads the upper triangle alone, and changes neither.
cholmod_sparse view_of(const Eigen::SparseMatrix<double>& A) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(A.rows());
  view.ncol = static_cast<std::size_t>(A.cols());
  view.nzmax = static_cast<std::size_t>(A.nonZeros());
  view.p = const_cast<int*>(A.outerIndexPtr());
  view.i = const_cast<int*>(A.innerIndexPtr());
  view.x = const_cast<double*>(A.valuePtr());
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

cholmod_dense view_of(const Eigen::MatrixXd& B) {
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(B.rows());
  view.ncol = static_cast<std::size_t>(B.cols());
  view.nzmax = static_cast<std::size_t>(B.size());
  view.x = const_cast<double*>(B.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

[[noreturn]] void fail(int status) {
  if (status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status == CHOLMOD_NOT_POSDEF)
    throw std::runtime_error("CHOLMOD: the matrix is not positive definite");
  throw std::runtime_error("CHOLMOD: status " + std::to_string(status));
}

}  // namespace

struct SparseCholesky::Factors {
  CholmodWorkspace workspace;
  cholmod_factor* factor = nullptr;

  // Not METIS, which draws from the random numbers that all threads share.
  Factors() { workspace.common.method[0].ordering = CHOLMOD_AMD; }
  ~Factors() { cholmod_free_factor(&factor, &workspace.common); }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;

  Eigen::MatrixXd solved(int system, const Eigen::MatrixXd& B) {
    cholmod_dense view = view_of(B);
    cholmod_dense* x = cholmod_solve(system, factor, &view, &workspace.common);
    if (!x) fail(workspace.common.status);
    const Eigen::MatrixXd result =
        Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), B.rows(), B.cols());
    cholmod_free_dense(&x, &workspace.common);
    return result;
  }
};

SparseCholesky::SparseCholesky() : factors_(std::make_unique<Factors>()) {
  use_one_blas_thread();
}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::factorise(const Eigen::SparseMatrix<double>& A) {
  cholmod_sparse view = view_of(A);
  cholmod_common* common = &factors_->workspace.common;
  cholmod_factor*& factor = factors_->factor;
  if (!factor) factor = cholmod_analyze(&view, common);
  if (!factor) fail(common->status);
  common->status = CHOLMOD_OK;
  use_one_openmp_thread();
  cholmod_factorize(&view, factor, common);
  if (common->status != CHOLMOD_OK) fail(common->status);
  if (factor->minor < factor->n) fail(CHOLMOD_NOT_POSDEF);
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& B) const {
  return factors_->solved(CHOLMOD_A, B);
}

// A = Pᵀ L Lᵀ P.
Eigen::MatrixXd SparseCholesky::correlated(const Eigen::MatrixXd& Z) const {
  return factors_->solved(CHOLMOD_Pt, factors_->solved(CHOLMOD_Lt, Z));
}

// A = Pᵀ L Lᵀ P: the root is Pᵀ L.
Eigen::MatrixXd SparseCholesky::whitened(const Eigen::MatrixXd& Z) const {
  return factors_->solved(CHOLMOD_L, factors_->solved(CHOLMOD_P, Z));
}

// CHOLMOD has no product with L. Supernodes are trapezoids: their first rows are their own columns.
Eigen::MatrixXd SparseCholesky::coloured(const Eigen::MatrixXd& Z) const {
  const cholmod_factor& L = *factors_->factor;
  const auto* first = static_cast<const int*>(L.super);
  const auto *pointer = static_cast<const int*>(L.pi), *begin = static_cast<const int*>(L.px);
  const auto* row = static_cast<const int*>(L.s);
  const auto* values = static_cast<const double*>(L.x);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(Z.rows(), Z.cols());
  for (std::size_t s = 0; s < L.nsuper; ++s) {
    const Eigen::Index rows = pointer[s + 1] - pointer[s], columns = first[s + 1] - first[s];
    const Eigen::Map<const Eigen::MatrixXd> block(values + begin[s], rows, columns);
    const auto part = Z.middleRows(first[s], columns);
    const Eigen::MatrixXd own = block.topRows(columns).triangularView<Eigen::Lower>() * part;
    const Eigen::MatrixXd below = block.bottomRows(rows - columns) * part;
    for (Eigen::Index k = 0; k < rows; ++k)
      result.row(row[pointer[s] + k]) += k < columns ? own.row(k) : below.row(k - columns);
  }
  return factors_->solved(CHOLMOD_Pt, result);
}

// Twice that of L, whose supernodes are trapezoids, column after column.
double SparseCholesky::log_determinant() const {
  const cholmod_factor& L = *factors_->factor;
  const auto* first = static_cast<const int*>(L.super);
  const auto *rows = static_cast<const int*>(L.pi), *begin = static_cast<const int*>(L.px);
  const auto* values = static_cast<const double*>(L.x);
  double sum = 0;
  for (std::size_t s = 0; s < L.nsuper; ++s) {
    const int stride = rows[s + 1] - rows[s];
    for (int k = 0; k < first[s + 1] - first[s]; ++k)
      sum += std::log(values[begin[s] + k * (stride + 1)]);
  }
  return 2 * sum;
}

}  // namespace traceraft::suitesparse
