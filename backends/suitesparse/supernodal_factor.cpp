#include "backends/suitesparse/supernodal_factor.hpp"

#include <algorithm>

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

// y += a0 x0 + a1 x1 + a2 x2 + a3 x3, four columns of L at a time.
TRACERAFT_CLONES
void add_four(int n, const Real* __restrict l, int stride, const Real* a, Real* __restrict y) {
  const Real *l0 = l, *l1 = l + stride, *l2 = l1 + stride, *l3 = l2 + stride;
  for (int i = 0; i < n; ++i) y[i] += a[0] * l0[i] + a[1] * l1[i] + a[2] * l2[i] + a[3] * l3[i];
}

TRACERAFT_CLONES
void add_one(int n, const Real* __restrict l, Real a, Real* __restrict y) {
  for (int i = 0; i < n; ++i) y[i] += a * l[i];
}

// Eight numbers at a time, summed in one fixed order.
constexpr int kWide = 8;
using Wide =
    Real __attribute__((vector_size(kWide * sizeof(Real)), aligned(alignof(Real)), may_alias));
const Wide& wide(const Real* at) {
  return *reinterpret_cast<const Wide*>(at);
}

Real sum_of(const Wide& v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

TRACERAFT_CLONES
Real dot_one(int n, const Real* l, const Real* y) {
  Wide sum = {};
  int i = 0;
  for (; i + kWide <= n; i += kWide) sum += wide(l + i) * wide(y + i);
  Real total = sum_of(sum);
  for (; i < n; ++i) total += l[i] * y[i];
  return total;
}

// result -= Lᵀ y for four columns.
TRACERAFT_CLONES
void subtract_dot_four(int n, const Real* l, int stride, const Real* y, Real* result) {
  const Real *l0 = l, *l1 = l + stride, *l2 = l1 + stride, *l3 = l2 + stride;
  Wide sum0 = {}, sum1 = {}, sum2 = {}, sum3 = {};
  int i = 0;
  for (; i + kWide <= n; i += kWide) {
    const Wide value = wide(y + i);
    sum0 += wide(l0 + i) * value;
    sum1 += wide(l1 + i) * value;
    sum2 += wide(l2 + i) * value;
    sum3 += wide(l3 + i) * value;
  }
  Real total[4] = {sum_of(sum0), sum_of(sum1), sum_of(sum2), sum_of(sum3)};
  for (; i < n; ++i) {
    total[0] += l0[i] * y[i];
    total[1] += l1[i] * y[i];
    total[2] += l2[i] * y[i];
    total[3] += l3[i] * y[i];
  }
  for (int c = 0; c < 4; ++c) result[c] -= total[c];
}

}  // namespace

void SupernodalFactor::copy(const cholmod_factor& factor) {
  const int* super = static_cast<const int*>(factor.super);
  const int* row_begin = static_cast<const int*>(factor.pi);
  const int* value_begin = static_cast<const int*>(factor.px);
  const int* rows = static_cast<const int*>(factor.s);
  const double* values = static_cast<const double*>(factor.x);
  if (supernodes_.empty()) {
    const int* order = static_cast<const int*>(factor.Perm);
    permutation_.assign(order, order + factor.n);
    rows_.assign(rows, rows + factor.ssize);
    for (std::size_t s = 0; s < factor.nsuper; ++s)
      supernodes_.push_back({super[s], super[s + 1] - super[s], row_begin[s + 1] - row_begin[s],
                             static_cast<std::size_t>(row_begin[s]),
                             static_cast<std::size_t>(value_begin[s])});
  }
  values_.resize(factor.xsize);
  std::transform(values, values + factor.xsize, values_.begin(),
                 [](double value) { return static_cast<Real>(value); });
}

void SupernodalFactor::forward(const Supernode& node, Real* x, Real* below) const {
  const Real* l = values_.data() + node.value_begin;
  const int* row = rows_.data() + node.row_begin;
  Real* own = x + node.first_column;
  const int count = node.rows - node.columns;
  // The triangle, column by column.
  for (int j = 0; j < node.columns; ++j) {
    const Real* column = l + static_cast<std::size_t>(j) * node.rows;
    own[j] /= column[j];
    add_one(node.columns - j - 1, column + j + 1, -own[j], own + j + 1);
  }
  std::fill(below, below + count, Real{0});
  const Real* rectangle = l + node.columns;
  int j = 0;
  for (; j + 4 <= node.columns; j += 4)
    add_four(count, rectangle + static_cast<std::size_t>(j) * node.rows, node.rows, own + j, below);
  for (; j < node.columns; ++j)
    add_one(count, rectangle + static_cast<std::size_t>(j) * node.rows, own[j], below);
  for (int i = 0; i < count; ++i) x[row[node.columns + i]] -= below[i];
}

void SupernodalFactor::backward(const Supernode& node, Real* x, Real* below) const {
  const Real* l = values_.data() + node.value_begin;
  const int* row = rows_.data() + node.row_begin;
  Real* own = x + node.first_column;
  const int count = node.rows - node.columns;
  for (int i = 0; i < count; ++i) below[i] = x[row[node.columns + i]];
  const Real* rectangle = l + node.columns;
  int j = 0;
  for (; j + 4 <= node.columns; j += 4)
    subtract_dot_four(count, rectangle + static_cast<std::size_t>(j) * node.rows, node.rows, below,
                      own + j);
  for (; j < node.columns; ++j)
    own[j] -= dot_one(count, rectangle + static_cast<std::size_t>(j) * node.rows, below);
  for (j = node.columns - 1; j >= 0; --j) {
    const Real* column = l + static_cast<std::size_t>(j) * node.rows;
    own[j] -= dot_one(node.columns - j - 1, column + j + 1, own + j + 1);
    own[j] /= column[j];
  }
}

void SupernodalFactor::solve(ConstVec b, VecRef x, Work& work) const {
  const FlushSubnormals flush;
  const std::size_t n = permutation_.size();
  work.x.resize(n);
  work.gathered.resize(n);
  for (std::size_t k = 0; k < n; ++k) work.x[k] = static_cast<Real>(b[permutation_[k]]);
  for (const Supernode& node : supernodes_) forward(node, work.x.data(), work.gathered.data());
  for (auto node = supernodes_.rbegin(); node != supernodes_.rend(); ++node)
    backward(*node, work.x.data(), work.gathered.data());
  for (std::size_t k = 0; k < n; ++k) x[permutation_[k]] = static_cast<double>(work.x[k]);
}

}  // namespace traceraft
