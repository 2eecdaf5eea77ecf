#include "backends/suitesparse/supernodal_solver.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "backends/suitesparse/blas.hpp"
#include "backends/suitesparse/instruction_sets.hpp"
#include "backends/suitesparse/multifrontal.hpp"

namespace traceraft::suitesparse {
namespace {

using Real = float;
using Stored = std::uint16_t;  // bfloat16: the upper half of a float

#define TRACERAFT_INLINE __attribute__((always_inline)) inline

// Sixteen numbers at a time, summed in one fixed order. Columns are read beyond their ends, up to
// fifteen numbers into what follows. These products go to numbers that nobody reads, or are zero.
constexpr int kWide = 16;
using Wide =
    Real __attribute__((vector_size(kWide * sizeof(Real)), aligned(alignof(Real)), may_alias));
using Bits = std::uint32_t __attribute__((vector_size(kWide * sizeof(std::uint32_t))));
using Halves = Stored
    __attribute__((vector_size(kWide * sizeof(Stored)), aligned(alignof(Stored)), may_alias));

TRACERAFT_INLINE void load(const Stored* l, Wide& value) {
  const Bits bits = __builtin_convertvector(*reinterpret_cast<const Halves*>(l), Bits) << 16;
  value = reinterpret_cast<const Wide&>(bits);
}

TRACERAFT_INLINE Real real(Stored value) {
  const std::uint32_t bits = static_cast<std::uint32_t>(value) << 16;
  Real result;
  std::memcpy(&result, &bits, sizeof result);
  return result;
}

// Rounded to the nearest, ties to even. The numbers of a factor are finite.
TRACERAFT_INLINE Stored stored(Real value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return static_cast<Stored>((bits + 0x7fff + ((bits >> 16) & 1)) >> 16);
}

TRACERAFT_INLINE Real sum_of(const Wide& v) {
  Real sum[8];
  for (int i = 0; i < 8; ++i) sum[i] = v[i] + v[i + 8];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

// A group: K neighbouring columns of L from the diagonal of the first one downwards, `rows` numbers
// each, with reciprocals on the diagonal. Solves for the first K numbers of x and subtracts what
// they contribute to the others.
template <int K>
TRACERAFT_INLINE void eliminate(const Stored* l, int rows, Real* __restrict x) {
  Real solved[K];
  for (int a = 0; a < K; ++a) {
    for (int b = 0; b < a; ++b) x[a] -= real(l[b * rows + a]) * solved[b];
    solved[a] = x[a] *= real(l[a * rows + a]);
  }
  for (int i = K; i < rows; i += kWide) {
    Wide sum, column;
    load(l + i, sum);
    sum *= solved[0];
    for (int a = 1; a < K; ++a) {
      load(l + a * rows + i, column);
      sum += solved[a] * column;
    }
    *reinterpret_cast<Wide*>(x + i) -= sum;
  }
}

// Solves for the first K numbers of x, given the others and zeros after them, with the transpose.
template <int K>
TRACERAFT_INLINE void substitute(const Stored* l, int rows, Real* __restrict x) {
  Wide sum[K] = {}, column;
  for (int i = K; i < rows; i += kWide)
    for (int a = 0; a < K; ++a) {
      load(l + a * rows + i, column);
      sum[a] += column * *reinterpret_cast<const Wide*>(x + i);
    }
  for (int a = K - 1; a >= 0; --a) {
    x[a] -= sum_of(sum[a]);
    for (int b = a + 1; b < K; ++b) x[a] -= real(l[a * rows + b]) * x[b];
    x[a] *= real(l[a * rows + a]);
  }
}

// A supernode's columns are in groups of four, after those that make no group.
TRACERAFT_INLINE int group_size(int columns, int first) {
  return first == 0 && columns % 4 > 0 ? columns % 4 : 4;
}

std::size_t values_of_groups(int columns, int rows) {
  std::size_t count = 0;
  for (int j = 0; j < columns; j += group_size(columns, j))
    count += static_cast<std::size_t>(group_size(columns, j)) * (rows - j);
  return count;
}

// x: a contiguous copy of what belongs to the supernode's rows.
TRACERAFT_CLONES
void forward_dense(const Stored* l, int columns, int rows, Real* x) {
  int j = columns % 4;
  if (j == 1) eliminate<1>(l, rows, x);
  if (j == 2) eliminate<2>(l, rows, x);
  if (j == 3) eliminate<3>(l, rows, x);
  l += static_cast<std::size_t>(j) * rows;
  for (; j < columns; j += 4) {
    eliminate<4>(l, rows - j, x + j);
    l += static_cast<std::size_t>(4) * (rows - j);
  }
}

// l: the end of the supernode's numbers.
TRACERAFT_CLONES
void backward_dense(const Stored* l, int columns, int rows, Real* x) {
  const int single = columns % 4;
  for (int j = columns - 4; j >= single; j -= 4) {
    l -= static_cast<std::size_t>(4) * (rows - j);
    substitute<4>(l, rows - j, x + j);
  }
  l -= static_cast<std::size_t>(single) * rows;
  if (single == 3) substitute<3>(l, rows, x);
  if (single == 2) substitute<2>(l, rows, x);
  if (single == 1) substitute<1>(l, rows, x);
}

// The columns of one supernode, `rows` apart.
TRACERAFT_CLONES
void copy_dense(const float* from, int columns, int rows, Stored* to) {
  for (int j = 0; j < columns; j += group_size(columns, j))
    for (int a = 0; a < group_size(columns, j); ++a) {
      const float* column = from + static_cast<std::size_t>(j + a) * rows + j;
      for (int i = 0; i < rows - j; ++i) to[i] = stored(column[i]);
      to[a] = stored(1 / column[a]);
      to += rows - j;
    }
}

// For one right-hand side and the small supernodes of a surface mesh, reading the factor costs more
// than the arithmetic: kept in 16 bits it is half as long as in single precision. Their eight
// significant ones are enough for a preconditioner, whose Krylov method runs in double precision;
// arithmetic is in single precision. Calls of BLAS would cost more than both.
//
// Two threads take the two branches of the elimination tree, then one what both contribute to.
// Contributions are added up in one order, so results do not depend on the number of threads.
class SupernodalSolver final : public linear::SpdSolver {
 public:
  SupernodalSolver(std::shared_ptr<const SupernodalStructure> structure, int lanes);
  Status factorise(const fem::CsrMatrix& A) override;
  void solve(VecView b, VecRef x, const ThreadTeam& team, int lane) override;

 private:
  // The vectors that a lane works with.
  struct Work {
    std::vector<Real> x;
    std::vector<Real> dense[2], above[2];  // of each branch: a supernode's rows; sums for the top
  };
  void keep(std::size_t supernode, const float* columns);
  void forward(int supernode, Real* x, Real* above, Real* work) const;
  void backward(int supernode, Real* x, Real* work) const;

  std::shared_ptr<const SupernodalStructure> structure_;
  std::vector<std::size_t> value_begin_;  // of each supernode's groups of columns; the end
  std::vector<Stored> values_;
  std::vector<Work> work_;
};

SupernodalSolver::SupernodalSolver(std::shared_ptr<const SupernodalStructure> structure, int lanes)
    : structure_(std::move(structure)), work_(lanes) {
  value_begin_.push_back(0);
  for (const Supernode& node : structure_->supernodes)
    value_begin_.push_back(value_begin_.back() + values_of_groups(node.columns, node.rows));
}

void SupernodalSolver::keep(std::size_t supernode, const float* columns) {
  const Supernode& node = structure_->supernodes[supernode];
  copy_dense(columns, node.columns, node.rows, values_.data() + value_begin_[supernode]);
}

Status SupernodalSolver::factorise(const fem::CsrMatrix& A) {
  values_.resize(value_begin_.back() + kWide);
  const bool positive = factorise_multifrontal(
      *structure_, A.values, [this](std::size_t s, const float* columns) { keep(s, columns); });
  return positive ? Status{} : Status::retry("the matrix is not positive definite");
}

// above: where contributions to the rows of the top go, or x itself from there on.
void SupernodalSolver::forward(int supernode, Real* x, Real* above, Real* work) const {
  const Supernode& node = structure_->supernodes[supernode];
  const int* row = structure_->rows.data() + node.row_begin;
  Real* own = x + node.first_column;
  std::copy(own, own + node.columns, work);
  std::fill(work + node.columns, work + node.rows, Real{0});
  forward_dense(values_.data() + value_begin_[supernode], node.columns, node.rows, work);
  std::copy(work, work + node.columns, own);
  const int split = std::max(node.columns, node.below_top);
  for (int i = node.columns; i < split; ++i) x[row[i]] += work[i];
  for (int i = split; i < node.rows; ++i) above[row[i] - structure_->top_row] += work[i];
}

void SupernodalSolver::backward(int supernode, Real* x, Real* work) const {
  const Supernode& node = structure_->supernodes[supernode];
  const int* row = structure_->rows.data() + node.row_begin;
  Real* own = x + node.first_column;
  std::copy(own, own + node.columns, work);
  for (int i = node.columns; i < node.rows; ++i) work[i] = x[row[i]];
  std::fill(work + node.rows, work + node.rows + kWide, Real{0});
  backward_dense(values_.data() + value_begin_[supernode + 1], node.columns, node.rows, work);
  std::copy(work, work + node.columns, own);
}

void SupernodalSolver::solve(VecView b, VecRef x, const ThreadTeam& team, int lane) {
  Work& work = work_[lane];
  const std::vector<int>& permutation = structure_->permutation;
  const int* branch_begin = structure_->branch_begin;
  const int top_row = structure_->top_row;
  const std::size_t n = permutation.size(), top = n - static_cast<std::size_t>(top_row);
  work.x.resize(n);
  Real* solution = work.x.data();
  const auto for_branches = [&](const auto& action) {
    team.run([&](int part) {
      const FlushSubnormals flush;
      for (int branch = part; branch < 2; branch += team.size()) action(branch);
    });
  };
  const FlushSubnormals flush;
  for (std::size_t k = 0; k < n; ++k) solution[k] = static_cast<Real>(b[permutation[k]]);
  for_branches([&](int branch) {
    work.dense[branch].resize(structure_->most_rows + kWide);
    work.above[branch].assign(top, Real{0});
    for (int s = branch_begin[branch]; s < branch_begin[branch + 1]; ++s)
      forward(s, solution, work.above[branch].data(), work.dense[branch].data());
  });
  for (std::size_t k = 0; k < top; ++k)
    solution[top_row + k] += work.above[0][k] + work.above[1][k];
  const int count = static_cast<int>(structure_->supernodes.size());
  for (int s = branch_begin[2]; s < count; ++s)
    forward(s, solution, solution + top_row, work.dense[0].data());
  for (int s = count - 1; s >= branch_begin[2]; --s) backward(s, solution, work.dense[0].data());
  for_branches([&](int branch) {
    for (int s = branch_begin[branch + 1] - 1; s >= branch_begin[branch]; --s)
      backward(s, solution, work.dense[branch].data());
  });
  for (std::size_t k = 0; k < n; ++k) x[permutation[k]] = static_cast<double>(solution[k]);
}

}  // namespace

linear::SpdSolverFactory supernodal_factory(fem::PatternPtr pattern, Ordering ordering) {
  use_one_blas_thread();
  struct Analysis {
    std::once_flag once;
    std::shared_ptr<const SupernodalStructure> structure;
  };
  return [pattern, ordering,
          analysis = std::make_shared<Analysis>()](int lanes) -> linear::SpdSolverPtr {
    std::call_once(analysis->once, [&] { analysis->structure = analyse(*pattern, ordering); });
    return std::make_unique<SupernodalSolver>(analysis->structure, lanes);
  };
}

}  // namespace traceraft::suitesparse
