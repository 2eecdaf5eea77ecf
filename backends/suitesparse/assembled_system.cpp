#include "backends/suitesparse/assembled_system.hpp"

#include <cmath>

#include "kernel/linear/linear_solver.hpp"

namespace traceraft::suitesparse {

void AssembledSystem::build_rows() {
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

void AssembledSystem::fill(const linear::BlockJacobian& J) {
  if (begin_.empty()) build_rows();
  const double root = std::sqrt(J.shift);
  const int n = pattern_->rows();
  std::size_t at = 0;
  const auto copy = [&](int row, double factor, const fem::CsrMatrix& block) {
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

Vec AssembledSystem::right_side(const linear::BlockJacobian& J, VecView b) const {
  const int n = pattern_->rows();
  Vec right(2 * n);
  right.head(n) = -b.tail(n);
  right.tail(n) = b.head(n) / std::sqrt(J.shift);
  return right;
}

void AssembledSystem::take_solution(const linear::BlockJacobian& J, VecView b, VecView solution,
                                    VecRef x) const {
  const int n = pattern_->rows();
  x.head(n) = solution.head(n);
  x.tail(n) = std::sqrt(J.shift) * solution.tail(n);
  linear::restore_mass(J, b, x);
}

}  // namespace traceraft::suitesparse
