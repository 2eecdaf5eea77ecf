// A copy of a supernodal Cholesky factor, stored for fast solves with one right-hand side.
#pragma once

#include <suitesparse/cholmod.h>

#include <cstdint>
#include <vector>

#include "kernel/core/thread_team.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {

// CHOLMOD solves through one BLAS call per supernode. For one right-hand side and the small
// supernodes of a surface mesh, the calls (each takes a lock that the threads of a process share)
// cost more than the arithmetic, and reading the factor costs more than both: kept in 16 bits it is
// a quarter as long. Their eight significant ones are enough for a preconditioner, whose Krylov
// method runs in double precision; arithmetic is in single precision.
//
// The elimination tree is cut into two branches, which two threads take, and what both contribute
// to. Contributions are added up in one order, so results do not depend on the number of threads.
class SupernodalFactor {
 public:
  using Real = float;
  using Stored = std::uint16_t;  // bfloat16: the upper half of a float

  // Copies a factor P A Pᵀ = L Lᵀ; reuses the memory of an earlier copy.
  void copy(const cholmod_factor& factor);

  // x = A⁻¹ b to the precision of Real. Threads may solve at the same time, each with its own work.
  struct Work {
    std::vector<Real> x;
    std::vector<Real> dense[2], above[2];  // of each branch: a supernode's rows; sums for the top
  };
  void solve(ConstVec b, VecRef x, const ThreadTeam& team, Work& work) const;

 private:
  struct Supernode {
    int first_column, columns, rows;     // the first `columns` rows are the triangular part,
    int below_top;                       // the first `below_top` rows belong to the node's branch
    std::size_t row_begin;               // in rows_
    std::size_t value_begin, value_end;  // in values_: its groups of columns
  };
  void read_structure(const cholmod_factor& factor);
  void find_branches();
  void forward(const Supernode& node, Real* x, Real* above, Real* work) const;
  void backward(const Supernode& node, Real* x, Real* work) const;

  std::vector<int> permutation_;
  std::vector<Supernode> supernodes_;  // in postorder
  int branch_begin_[3] = {0, 0, 0};    // supernodes of the branches; from the last on: the top
  int top_row_ = 0;                    // first row of the top
  int most_rows_ = 0;
  std::vector<int> rows_;
  std::vector<Stored> values_;
};

}  // namespace traceraft
