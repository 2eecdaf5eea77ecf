#include "backends/suitesparse/multifrontal.hpp"

#include <algorithm>
#include <cmath>

#include "backends/suitesparse/instruction_sets.hpp"

extern "C" {
void strsm_(const char* side, const char* uplo, const char* transpose, const char* diagonal,
            const int* m, const int* n, const float* alpha, const float* a, const int* lda,
            float* b, const int* ldb);
void sgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n,
            const int* k, const float* alpha, const float* a, const int* lda, const float* b,
            const int* ldb, const float* beta, float* c, const int* ldc);
void ssyrk_(const char* uplo, const char* transpose, const int* n, const int* k, const float* alpha,
            const float* a, const int* lda, const float* beta, float* c, const int* ldc);
}

namespace traceraft::suitesparse {
namespace {

// Both are relative to the entry of the matrix on the diagonal. A pivot between −kRoundoff and
// kLeastPivot is zero within roundoff, as that of the constants at long steps, and becomes the
// latter. A more negative one means that the matrix is not positive definite.
constexpr float kLeastPivot = 1e-6F, kRoundoff = 1e-4F;
constexpr int kBlock = 48;  // columns that are factorised without BLAS
// Below so many multiplications a call of BLAS takes longer than the loops here.
constexpr long kFewProducts = 20000;

// Cholesky factor of the leading n columns of an m x n trapezoid; rows below are solved for, too.
TRACERAFT_CLONES
bool factorise_columns(float* a, int m, int n, int stride, const float* diagonal) {
  for (int j = 0; j < n; ++j) {
    float* column = a + static_cast<std::size_t>(j) * stride;
    if (!(column[j] > -kRoundoff * diagonal[j]) || !std::isfinite(column[j])) return false;
    const float root = std::sqrt(std::max(column[j], kLeastPivot * diagonal[j]));
    column[j] = root;
    const float scale = 1 / root;
    for (int i = j + 1; i < m; ++i) column[i] *= scale;
    for (int k = j + 1; k < n; ++k) {
      float* later = a + static_cast<std::size_t>(k) * stride;
      const float factor = column[k];
      for (int i = k; i < m; ++i) later[i] -= factor * column[i];
    }
  }
  return true;
}

// The lower triangle of U −= B Bᵀ, B being m x n.
TRACERAFT_CLONES
void subtract_few_products(const float* b, int m, int n, int stride, float* u) {
  for (int j = 0; j < m; ++j) {
    float* column = u + static_cast<std::size_t>(j) * m;
    int k = 0;
    for (; k + 4 <= n; k += 4) {
      const float* b0 = b + static_cast<std::size_t>(k) * stride;
      const float *b1 = b0 + stride, *b2 = b1 + stride, *b3 = b2 + stride;
      const float f0 = b0[j], f1 = b1[j], f2 = b2[j], f3 = b3[j];
      for (int i = j; i < m; ++i)
        column[i] -= (f0 * b0[i] + f1 * b1[i]) + (f2 * b2[i] + f3 * b3[i]);
    }
    for (; k < n; ++k) {
      const float* b0 = b + static_cast<std::size_t>(k) * stride;
      const float f0 = b0[j];
      for (int i = j; i < m; ++i) column[i] -= f0 * b0[i];
    }
  }
}

void subtract_products(const float* b, int m, int n, int stride, float* u) {
  if (static_cast<long>(m) * m * n < kFewProducts) return subtract_few_products(b, m, n, stride, u);
  const float minus = -1, one = 1;
  ssyrk_("L", "N", &m, &n, &minus, b, &stride, &one, u, &m);
}

// The dense columns of a supernode and the matrix that its elimination leaves for the parent.
class Front {
 public:
  Front(const SupernodalStructure& structure, const std::vector<double>& values)
      : structure_(structure),
        values_(values),
        columns_(structure.largest_trapezoid),
        stack_(structure.deepest_stack) {}

  const float* columns() const { return columns_.data(); }

  // Supernodes come in postorder: the updates of the children are at the end of the stack.
  bool eliminate(const Supernode& node) {
    const int below = node.rows - node.columns;
    const std::size_t size = static_cast<std::size_t>(below) * below;
    read_entries(node);
    float* update = stack_.data() + used_;
    std::fill(update, update + size, 0.0F);
    const std::size_t waiting = add_children(node, update);
    if (!factorise(node)) return false;
    if (below > 0)
      subtract_products(columns_.data() + node.columns, below, node.columns, node.rows, update);
    std::copy(update, update + size, update - waiting);
    used_ += size - waiting;
    return true;
  }

 private:
  void read_entries(const Supernode& node) {
    std::fill_n(columns_.data(), static_cast<std::size_t>(node.rows) * node.columns, 0.0F);
    for (std::size_t e = node.entry_begin; e < node.entry_end; ++e) {
      const auto [source, place] = structure_.entries[e];
      columns_[place] = static_cast<float>(values_[source]);
    }
    diagonal_.resize(node.columns);
    for (int j = 0; j < node.columns; ++j)
      diagonal_[j] = std::fabs(columns_[static_cast<std::size_t>(j) * (node.rows + 1)]);
  }

  // The numbers that the children's updates take on the stack.
  std::size_t add_children(const Supernode& node, float* update) {
    std::size_t waiting = 0;
    for (int k = node.children - 1; k >= 0; --k) {
      const Supernode& child = structure_.supernodes[structure_.child_list[node.first_child + k]];
      const auto size = static_cast<std::size_t>(child.rows - child.columns);
      waiting += size * size;
      add_child(node, child, stack_.data() + used_ - waiting, update);
    }
    return waiting;
  }

  void add_child(const Supernode& node, const Supernode& child, const float* from, float* update) {
    const int* place = structure_.places.data() + child.row_begin + child.columns;
    const int size = child.rows - child.columns, below = node.rows - node.columns;
    for (int j = 0; j < size; ++j, from += size) {
      const bool own = place[j] < node.columns;
      const int first = own ? 0 : node.columns, stride = own ? node.rows : below;
      float* to =
          (own ? columns_.data() : update) + static_cast<std::size_t>(place[j] - first) * stride;
      for (int i = j; i < size; ++i) to[place[i] - first] += from[i];
    }
  }

  bool factorise(const Supernode& node) {
    const int m = node.rows, n = node.columns;
    const float one = 1, minus = -1;
    for (int j = 0; j < n; j += kBlock) {
      const int block = std::min(kBlock, n - j), end = j + block;
      float* corner = columns_.data() + static_cast<std::size_t>(j) * m + j;
      const int rows = m - j, below = m - end, right = n - end;
      const bool few = static_cast<long>(rows) * block * block < kFewProducts;
      if (!factorise_columns(corner, few ? rows : block, block, m, diagonal_.data() + j))
        return false;
      if (!few && below > 0)
        strsm_("R", "L", "T", "N", &below, &block, &one, corner, &m, corner + block, &m);
      if (right > 0)
        sgemm_("N", "T", &below, &right, &block, &minus, corner + block, &m, corner + block, &m,
               &one, columns_.data() + static_cast<std::size_t>(end) * m + end, &m);
    }
    return true;
  }

  const SupernodalStructure& structure_;
  const std::vector<double>& values_;
  std::vector<float> columns_, stack_, diagonal_;
  std::size_t used_ = 0;  // of the stack
};

}  // namespace

bool factorise_multifrontal(const SupernodalStructure& structure, const std::vector<double>& values,
                            const KeepColumns& keep) {
  const FlushSubnormals flush;
  Front front(structure, values);
  for (std::size_t s = 0; s < structure.supernodes.size(); ++s) {
    if (!front.eliminate(structure.supernodes[s])) return false;
    keep(s, front.columns());
  }
  return true;
}

}  // namespace traceraft::suitesparse
