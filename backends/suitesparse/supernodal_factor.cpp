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

#define TRACERAFT_INLINE __attribute__((always_inline)) inline

// Eight numbers at a time, summed in one fixed order.
constexpr int kWide = 8;
using Wide =
    Real __attribute__((vector_size(kWide * sizeof(Real)), aligned(alignof(Real)), may_alias));

TRACERAFT_INLINE Real sum_of(const Wide& v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

// The leading K columns of a trapezoid of L, `rows` from the diagonal of the first one downwards.
// Solves for the first K numbers of x and subtracts what they contribute to the others.
template <int K>
TRACERAFT_INLINE void eliminate(const Real* l, int stride, int rows, Real* __restrict x) {
  Real solved[K];
  for (int a = 0; a < K; ++a) {
    for (int b = 0; b < a; ++b) x[a] -= l[b * stride + a] * solved[b];
    solved[a] = x[a] /= l[a * stride + a];
  }
  for (int i = K; i < rows; ++i) {
    Real sum = 0;
    for (int a = 0; a < K; ++a) sum += solved[a] * l[a * stride + i];
    x[i] -= sum;
  }
}

// Solves for the first K numbers of x, given the others, with the transpose.
template <int K>
TRACERAFT_INLINE void substitute(const Real* l, int stride, int rows, Real* __restrict x) {
  Wide sum[K] = {};
  int i = K;
  for (; i + kWide <= rows; i += kWide)
    for (int a = 0; a < K; ++a)
      sum[a] += *reinterpret_cast<const Wide*>(l + a * stride + i) *
                *reinterpret_cast<const Wide*>(x + i);
  Real total[K];
  for (int a = 0; a < K; ++a) total[a] = sum_of(sum[a]);
  for (; i < rows; ++i)
    for (int a = 0; a < K; ++a) total[a] += l[a * stride + i] * x[i];
  for (int a = K - 1; a >= 0; --a) {
    x[a] -= total[a];
    for (int b = a + 1; b < K; ++b) x[a] -= l[a * stride + b] * x[b];
    x[a] /= l[a * stride + a];
  }
}

// A supernode's columns in groups of four, after those that make no group. x: a contiguous copy of
// what belongs to its rows; L is stored column by column, `rows` apart.
TRACERAFT_CLONES
void forward_dense(const Real* l, int columns, int rows, Real* x) {
  const auto at = [&](int j) { return l + static_cast<std::size_t>(j) * (rows + 1); };
  int j = columns % 4;
  if (j == 1) eliminate<1>(l, rows, rows, x);
  if (j == 2) eliminate<2>(l, rows, rows, x);
  if (j == 3) eliminate<3>(l, rows, rows, x);
  for (; j < columns; j += 4) eliminate<4>(at(j), rows, rows - j, x + j);
}

TRACERAFT_CLONES
void backward_dense(const Real* l, int columns, int rows, Real* x) {
  const auto at = [&](int j) { return l + static_cast<std::size_t>(j) * (rows + 1); };
  const int single = columns % 4;
  for (int j = columns - 4; j >= single; j -= 4) substitute<4>(at(j), rows, rows - j, x + j);
  if (single == 3) substitute<3>(l, rows, rows, x);
  if (single == 2) substitute<2>(l, rows, rows, x);
  if (single == 1) substitute<1>(l, rows, rows, x);
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

void SupernodalFactor::forward(const Supernode& node, Real* x, Real* work) const {
  const int* row = rows_.data() + node.row_begin;
  Real* own = x + node.first_column;
  std::copy(own, own + node.columns, work);
  std::fill(work + node.columns, work + node.rows, Real{0});
  forward_dense(values_.data() + node.value_begin, node.columns, node.rows, work);
  std::copy(work, work + node.columns, own);
  for (int i = node.columns; i < node.rows; ++i) x[row[i]] += work[i];
}

void SupernodalFactor::backward(const Supernode& node, Real* x, Real* work) const {
  const int* row = rows_.data() + node.row_begin;
  Real* own = x + node.first_column;
  std::copy(own, own + node.columns, work);
  for (int i = node.columns; i < node.rows; ++i) work[i] = x[row[i]];
  backward_dense(values_.data() + node.value_begin, node.columns, node.rows, work);
  std::copy(work, work + node.columns, own);
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
