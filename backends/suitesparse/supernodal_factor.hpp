// A copy of a supernodal Cholesky factor, stored for fast solves with one right-hand side.
#pragma once

#include <suitesparse/cholmod.h>

#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft {

// CHOLMOD solves through one BLAS call per supernode. For one right-hand side and the small
// supernodes of a surface mesh, the calls (each takes a lock that the threads of a process share)
// cost more than the arithmetic, and reading the factor costs more than both: kept in single
// precision it is half as long. That is enough for a preconditioner, whose Krylov method runs in
// double precision.
class SupernodalFactor {
 public:
  using Real = float;

  // Copies a factor P A Pᵀ = L Lᵀ; reuses the memory of an earlier copy.
  void copy(const cholmod_factor& factor);

  // x = A⁻¹ b to the precision of Real. Threads may solve at the same time, each with its own work.
  struct Work {
    std::vector<Real> x, gathered;
  };
  void solve(ConstVec b, VecRef x, Work& work) const;

 private:
  struct Supernode {
    int first_column, columns, rows;  // the first `columns` rows are the triangular part
    std::size_t row_begin;            // in rows_
    std::size_t value_begin;          // in values_, column by column
  };
  void forward(const Supernode& node, Real* x, Real* work) const;
  void backward(const Supernode& node, Real* x, Real* work) const;

  std::vector<int> permutation_;
  std::vector<Supernode> supernodes_;
  std::vector<int> rows_;
  std::vector<Real> values_;
};

}  // namespace traceraft
