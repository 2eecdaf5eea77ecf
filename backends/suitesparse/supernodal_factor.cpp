#include "backends/suitesparse/supernodal_factor.hpp"

#include <algorithm>
#include <cstring>

// Compiled for several instruction sets; the loader picks the best one for the processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TRACERAFT_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TRACERAFT_CLONES
#endif

namespace traceraft {
namespace {

// Far from the diagonal a factor decays to numbers that single precision holds as subnormals only,
// and arithmetic on those is a hundred times slower. While this lives they count as zero.
class FlushSubnormals {
 public:
#if defined(__SSE__)
  FlushSubnormals() : before_(__builtin_ia32_stmxcsr()) {
    __builtin_ia32_ldmxcsr(before_ | 0x8040);
  }
  ~FlushSubnormals() {
    __builtin_ia32_ldmxcsr(before_);
  }

 private:
  unsigned before_;
#endif
};

using Real = SupernodalFactor::Real;

#define TRACERAFT_INLINE __attribute__((always_inline)) inline

using Stored = SupernodalFactor::Stored;

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
TRACERAFT_INLINE Stored stored(double value) {
  const auto single = static_cast<Real>(value);
  std::uint32_t bits;
  std::memcpy(&bits, &single, sizeof bits);
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
void copy_dense(const double* from, int columns, int rows, Stored* to) {
  for (int j = 0; j < columns; j += group_size(columns, j))
    for (int a = 0; a < group_size(columns, j); ++a) {
      const double* column = from + static_cast<std::size_t>(j + a) * rows + j;
      for (int i = 0; i < rows - j; ++i) to[i] = stored(column[i]);
      to[a] = stored(1 / column[a]);
      to += rows - j;
    }
}

}  // namespace

void SupernodalFactor::read_structure(const cholmod_factor& factor) {
  const int* super = static_cast<const int*>(factor.super);
  const int* row_begin = static_cast<const int*>(factor.pi);
  const int* rows = static_cast<const int*>(factor.s);
  const int* order = static_cast<const int*>(factor.Perm);
  permutation_.assign(order, order + factor.n);
  rows_.assign(rows, rows + factor.ssize);
  std::size_t values = 0;
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const int count = row_begin[s + 1] - row_begin[s], columns = super[s + 1] - super[s];
    const std::size_t begin = values;
    values += values_of_groups(columns, count);
    supernodes_.push_back(
        {super[s], columns, count, count, static_cast<std::size_t>(row_begin[s]), begin, values});
    most_rows_ = std::max(most_rows_, count);
  }
  values_.assign(values + kWide, 0);
  find_branches();
}

// From the root downwards as long as a supernode has one child; the children of the first one with
// more become the branches, in two groups of about equal length in memory. In postorder a subtree
// is contiguous and ends with its root.
void SupernodalFactor::find_branches() {
  const int count = static_cast<int>(supernodes_.size());
  std::vector<int> supernode_of(permutation_.size()), first(count);
  std::vector<std::vector<int>> children(count + 1);  // the last: the roots
  for (int s = 0; s < count; ++s)
    for (int k = 0; k < supernodes_[s].columns; ++k)
      supernode_of[supernodes_[s].first_column + k] = s;
  for (int s = 0; s < count; ++s) {
    const Supernode& node = supernodes_[s];
    first[s] = children[s].empty() ? s : first[children[s].front()];
    const bool root = node.rows == node.columns;
    children[root ? count : supernode_of[rows_[node.row_begin + node.columns]]].push_back(s);
  }
  int top = count;
  while (children[top].size() == 1) top = children[top].front();
  const auto values_before = [&](int s) {
    return s < count ? supernodes_[s].value_begin : values_.size();
  };
  const std::vector<int>& branches = children[top];
  const int begin = branches.empty() ? 0 : first[branches.front()];
  const int end = branches.empty() ? 0 : branches.back() + 1;
  const std::size_t half = (values_before(begin) + values_before(end)) / 2;
  int middle = end;
  const auto distance = [&](int s) {
    const std::size_t at = values_before(s);
    return at > half ? at - half : half - at;
  };
  for (const int child : branches)
    if (distance(child + 1) < distance(middle)) middle = child + 1;
  branch_begin_[0] = begin;
  branch_begin_[1] = middle;
  branch_begin_[2] = end;
  top_row_ = end < count ? supernodes_[end].first_column : static_cast<int>(permutation_.size());
  for (Supernode& node : supernodes_) {
    const int* row = rows_.data() + node.row_begin;
    node.below_top = static_cast<int>(std::lower_bound(row, row + node.rows, top_row_) - row);
  }
}

void SupernodalFactor::copy(const cholmod_factor& factor) {
  if (supernodes_.empty()) read_structure(factor);
  const FlushSubnormals flush;
  const auto* values = static_cast<const double*>(factor.x);
  const auto* begin = static_cast<const int*>(factor.px);
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    const Supernode& node = supernodes_[s];
    copy_dense(values + begin[s], node.columns, node.rows, values_.data() + node.value_begin);
  }
}

// above: where contributions to the rows of the top go, or x itself from there on.
void SupernodalFactor::forward(const Supernode& node, Real* x, Real* above, Real* work) const {
  const int* row = rows_.data() + node.row_begin;
  Real* own = x + node.first_column;
  std::copy(own, own + node.columns, work);
  std::fill(work + node.columns, work + node.rows, Real{0});
  forward_dense(values_.data() + node.value_begin, node.columns, node.rows, work);
  std::copy(work, work + node.columns, own);
  const int split = std::max(node.columns, node.below_top);
  for (int i = node.columns; i < split; ++i) x[row[i]] += work[i];
  for (int i = split; i < node.rows; ++i) above[row[i] - top_row_] += work[i];
}

void SupernodalFactor::backward(const Supernode& node, Real* x, Real* work) const {
  const int* row = rows_.data() + node.row_begin;
  Real* own = x + node.first_column;
  std::copy(own, own + node.columns, work);
  for (int i = node.columns; i < node.rows; ++i) work[i] = x[row[i]];
  std::fill(work + node.rows, work + node.rows + kWide, Real{0});
  backward_dense(values_.data() + node.value_end, node.columns, node.rows, work);
  std::copy(work, work + node.columns, own);
}

void SupernodalFactor::solve(ConstVec b, VecRef x, const ThreadTeam& team, Work& work) const {
  const std::size_t n = permutation_.size(), top = n - static_cast<std::size_t>(top_row_);
  work.x.resize(n);
  Real* solution = work.x.data();
  const auto for_branches = [&](const auto& action) {
    team.run([&](int part) {
      const FlushSubnormals flush;
      for (int branch = part; branch < 2; branch += team.size()) action(branch);
    });
  };
  const FlushSubnormals flush;
  for (std::size_t k = 0; k < n; ++k) solution[k] = static_cast<Real>(b[permutation_[k]]);
  for_branches([&](int branch) {
    work.dense[branch].resize(most_rows_ + kWide);
    work.above[branch].assign(top, Real{0});
    for (int s = branch_begin_[branch]; s < branch_begin_[branch + 1]; ++s)
      forward(supernodes_[s], solution, work.above[branch].data(), work.dense[branch].data());
  });
  for (std::size_t k = 0; k < top; ++k)
    solution[top_row_ + k] += work.above[0][k] + work.above[1][k];
  const int count = static_cast<int>(supernodes_.size());
  for (int s = branch_begin_[2]; s < count; ++s)
    forward(supernodes_[s], solution, solution + top_row_, work.dense[0].data());
  for (int s = count - 1; s >= branch_begin_[2]; --s)
    backward(supernodes_[s], solution, work.dense[0].data());
  for_branches([&](int branch) {
    for (int s = branch_begin_[branch + 1] - 1; s >= branch_begin_[branch]; --s)
      backward(supernodes_[s], solution, work.dense[branch].data());
  });
  for (std::size_t k = 0; k < n; ++k) x[permutation_[k]] = static_cast<double>(solution[k]);
}

}  // namespace traceraft
