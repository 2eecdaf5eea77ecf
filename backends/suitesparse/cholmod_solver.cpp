#include "backends/suitesparse/cholmod_solver.hpp"

#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>

#include "backends/suitesparse/blas.hpp"
#include "backends/suitesparse/cholmod_workspace.hpp"
#include "backends/suitesparse/ordering.hpp"
#include "backends/suitesparse/supernodal_factor.hpp"
#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

// The upper triangle of the pattern in compressed columns: the lower triangle of the CSR rows, as
// the matrix is symmetric.
cholmod_sparse* upper_triangle(const SparsityPattern& pattern, std::vector<int>* source,
                               cholmod_common* common) {
  const int n = pattern.rows();
  const std::size_t entries = static_cast<std::size_t>(pattern.entries() + n) / 2;
  cholmod_sparse* A = cholmod_allocate_sparse(n, n, entries, 1, 1, 1, CHOLMOD_REAL, common);
  if (!A) throw std::bad_alloc();
  int* begin = static_cast<int*>(A->p);
  int* row = static_cast<int*>(A->i);
  int at = 0;
  for (int column = 0; column < n; ++column) {
    begin[column] = at;
    for (int k = pattern.row_begin[column]; k <= pattern.diagonal[column]; ++k) {
      row[at++] = pattern.column[k];
      if (source) source->push_back(k);
    }
  }
  begin[n] = at;
  return A;
}

class CholmodSolver final : public SpdSolver {
 public:
  CholmodSolver(const SparsityPattern& pattern, const std::vector<int>& ordering, int lanes)
      : work_(lanes) {
    cholmod_common* common = &workspace_.common;
    matrix_ = upper_triangle(pattern, &source_, common);
    common->method[0].ordering = CHOLMOD_GIVEN;
    std::vector<int> permutation = ordering;
    factor_ = cholmod_analyze_p(matrix_, permutation.data(), nullptr, 0, common);
    if (factor_) return;
    const int status = common->status;
    release();
    if (status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status == CHOLMOD_TOO_LARGE)
      throw InputError(
          "linear solver block: its factors have more than 2^31 entries on this mesh; use fewer "
          "--cells, or --linear-solver teko");
    throw std::runtime_error("CHOLMOD: symbolic analysis failed");
  }
  ~CholmodSolver() override { release(); }

  Status factorise(const CsrMatrix& A) override {
    double* values = static_cast<double*>(matrix_->x);
    for (std::size_t k = 0; k < source_.size(); ++k) values[k] = A.values[source_[k]];
    workspace_.common.status = CHOLMOD_OK;
    use_one_openmp_thread();
    cholmod_factorize(matrix_, factor_, &workspace_.common);
    if (workspace_.common.status == CHOLMOD_NOT_POSDEF || factor_->minor < factor_->n)
      return Status::retry("CHOLMOD: the matrix is not positive definite");
    if (workspace_.common.status < CHOLMOD_OK)
      return Status::retry("CHOLMOD: error " + std::to_string(workspace_.common.status));
    copy_.copy(*factor_);
    // Its numbers are needed no more, its structure is.
    cholmod_change_factor(CHOLMOD_PATTERN, 1, 1, 1, 1, factor_, &workspace_.common);
    return {};
  }

  void solve(ConstVec b, VecRef x, const ThreadTeam& team, int lane) override {
    copy_.solve(b, x, team, work_[lane]);
  }

 private:
  void release() {
    cholmod_free_factor(&factor_, &workspace_.common);
    cholmod_free_sparse(&matrix_, &workspace_.common);
  }

  CholmodWorkspace workspace_;
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
  std::vector<int> source_;
  SupernodalFactor copy_;
  std::vector<SupernodalFactor::Work> work_;
};

}  // namespace

std::vector<int> metis_ordering(const SparsityPattern& pattern) {
  // METIS seeds and draws from the C library's random numbers, which all threads share.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  CholmodWorkspace workspace;
  cholmod_sparse* A = upper_triangle(pattern, nullptr, &workspace.common);
  std::vector<int> ordering(pattern.rows());
  const int ok = cholmod_metis(A, nullptr, 0, 1, ordering.data(), &workspace.common);
  cholmod_free_sparse(&A, &workspace.common);
  if (!ok) throw std::runtime_error("METIS could not order the matrix");
  return ordering;
}

SpdSolverFactory cholmod_factory(PatternPtr pattern) {
  use_one_blas_thread();
  struct Ordering {
    std::once_flag once;
    std::vector<int> nodes;
  };
  return [pattern, ordering = std::make_shared<Ordering>()](int lanes) -> SpdSolverPtr {
    std::call_once(ordering->once, [&] { ordering->nodes = metis_ordering(*pattern); });
    return std::make_unique<CholmodSolver>(*pattern, ordering->nodes, lanes);
  };
}

}  // namespace traceraft
