#include "backends/suitesparse/direct_solver.hpp"

#include <suitesparse/umfpack.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "backends/suitesparse/blas.hpp"
#include "backends/suitesparse/ordering.hpp"
#include "kernel/core/binary.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft {
namespace {

// METIS draws from the process-wide random numbers of the C library: ordering once, for all lanes,
// keeps two threads from sharing them and a resumed run on the same order.
class SharedOrdering {
 public:
  const std::vector<int>& of(const SparsityPattern& pattern) {
    std::call_once(once_, [&] { ordering_ = metis_ordering(pattern); });
    return ordering_;
  }

 private:
  std::once_flag once_;
  std::vector<int> ordering_;
};

// The factors of one lane. Nothing is allocated before the first set-up: a fallback may never be
// needed.
class Lane {
 public:
  Lane(PatternPtr pattern, std::shared_ptr<SharedOrdering> ordering)
      : pattern_(std::move(pattern)), ordering_(std::move(ordering)) {
    umfpack_di_defaults(control_);
    control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  }
  ~Lane() {
    umfpack_di_free_symbolic(&symbolic_);
    umfpack_di_free_numeric(&numeric_);
  }
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  LinearStatistics statistics;

  Status setup(const BlockJacobian& J) {
    const ScopedTimer timer(statistics.setup_seconds);
    ++statistics.setups;
    if (begin_.empty()) build_rows();
    umfpack_di_free_numeric(&numeric_);
    if (!(J.shift > 0)) return Status::fatal("direct: the shift must be positive");
    fill_values(J);
    double info[UMFPACK_INFO];
    int flag = UMFPACK_OK;
    if (!symbolic_) flag = analyse(info);
    if (flag == UMFPACK_OK)
      flag = umfpack_di_numeric(begin_.data(), index_.data(), values_.data(), symbolic_, &numeric_,
                                control_, info);
    if (flag != UMFPACK_OK) {
      umfpack_di_free_numeric(&numeric_);
      return Status::retry(flag == UMFPACK_WARNING_singular_matrix
                               ? "UMFPACK: the matrix is singular"
                               : "UMFPACK: error " + std::to_string(flag));
    }
    return {};
  }

  SolveReport solve(const BlockJacobian& J, ConstVec b, VecRef x, double tolerance) {
    const ScopedTimer timer(statistics.solve_seconds);
    ++statistics.solves;
    if (!numeric_) return {Status::retry("direct: there is no factorisation")};
    const int n = J.block_size();
    const double root = std::sqrt(J.shift);
    Vec right(2 * n), solution(2 * n);
    right.head(n) = -b.tail(n);
    right.tail(n) = b.head(n) / root;
    double info[UMFPACK_INFO];
    // The arrays hold rows: UMFPACK sees the transpose and solves with its transpose.
    const int flag = umfpack_di_solve(UMFPACK_At, begin_.data(), index_.data(), values_.data(),
                                      solution.data(), right.data(), numeric_, control_, info);
    if (flag != UMFPACK_OK) return {Status::retry("UMFPACK: error " + std::to_string(flag))};
    x.head(n) = solution.head(n);
    x.tail(n) = root * solution.tail(n);
    restore_mass(J, b, x);
    ++statistics.iterations;
    statistics.most_iterations = 1;
    return {verify(J, b, x, tolerance), 1};
  }

 private:
  void build_rows() {
    const int n = pattern_->rows();
    begin_.assign(1, 0);
    for (int row = 0; row < 2 * n; ++row) {
      const int i = row % n;
      for (int block = 0; block < 2; ++block)
        for (int k = pattern_->row_begin[i]; k < pattern_->row_begin[i + 1]; ++k)
          index_.push_back(block * n + pattern_->column[k]);
      begin_.push_back(static_cast<int>(index_.size()));
    }
    values_.resize(index_.size());
  }

  void fill_values(const BlockJacobian& J) {
    const double root = std::sqrt(J.shift);
    const int n = pattern_->rows();
    std::size_t at = 0;
    const auto copy = [&](int row, double factor, const CsrMatrix& block) {
      for (int k = pattern_->row_begin[row]; k < pattern_->row_begin[row + 1]; ++k)
        values_[at++] = factor * block.values[k];
    };
    for (int i = 0; i < n; ++i) {
      copy(i, -1, J.mc);
      copy(i, -root, J.mm);
    }
    for (int i = 0; i < n; ++i) {
      copy(i, 1 / root, J.cc);
      copy(i, 1, J.cm);
    }
  }

  int analyse(double* info) {
    const int n = pattern_->rows();
    const std::vector<int>& order = ordering_->of(*pattern_);
    std::vector<int> pairs;
    for (const int i : order) pairs.insert(pairs.end(), {i, i + n});
    return umfpack_di_qsymbolic(2 * n, 2 * n, begin_.data(), index_.data(), values_.data(),
                                pairs.data(), &symbolic_, control_, info);
  }

  // The contract: never report a wrong x as ok. LU of a poorly scaled system is checked, too.
  static Status verify(const BlockJacobian& J, ConstVec b, ConstVec x, double tolerance) {
    Vec defect(b.size());
    J.multiply(x, defect, ThreadTeam(1));
    defect = b - defect;
    const double relative = scaled_norm(J, defect) / scaled_norm(J, b);
    if (b.isZero(0) || relative <= tolerance) return {};
    return Status::retry("UMFPACK: relative residual " + std::to_string(relative));
  }

  PatternPtr pattern_;
  std::shared_ptr<SharedOrdering> ordering_;
  std::vector<int> begin_, index_;
  std::vector<double> values_;
  double control_[UMFPACK_CONTROL];
  void *symbolic_ = nullptr, *numeric_ = nullptr;
};

class DirectSolver final : public LinearSolver {
 public:
  DirectSolver(const PatternPtr& pattern, int lanes) {
    use_one_blas_thread();
    const auto ordering = std::make_shared<SharedOrdering>();
    for (int lane = 0; lane < lanes; ++lane)
      lanes_.push_back(std::make_unique<Lane>(pattern, ordering));
  }
  std::string name() const override { return "direct"; }
  bool shares_factors() const override { return false; }
  bool wants_setup(const BlockJacobian&, int) const override { return true; }
  Status setup(const BlockJacobian& J, int lane) override { return lanes_[lane]->setup(J); }
  SolveReport solve(const BlockJacobian& J, ConstVec b, VecRef x, double tolerance,
                    int lane) override {
    return lanes_[lane]->solve(J, b, x, tolerance);
  }
  LinearStatistics statistics() const override {
    LinearStatistics total;
    for (const auto& lane : lanes_) total = total + lane->statistics;
    return total;
  }
  void save(std::ostream& out) const override {
    for (const auto& lane : lanes_) write_binary(out, lane->statistics);
  }
  void load(std::istream& in) override {
    for (const auto& lane : lanes_) read_binary(in, lane->statistics);
  }

 private:
  std::vector<std::unique_ptr<Lane>> lanes_;
};

}  // namespace

LinearSolverPtr make_direct_solver(const PatternPtr& pattern, int lanes) {
  return std::make_unique<DirectSolver>(pattern, lanes);
}

}  // namespace traceraft
