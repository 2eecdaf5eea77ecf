// A supernodal Cholesky factor, stored for fast solves with one right-hand side.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backends/suitesparse/supernodal_structure.hpp"
#include "kernel/core/thread_team.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {

// For one right-hand side and the small supernodes of a surface mesh, reading the factor costs more
// than the arithmetic: kept in 16 bits it is half as long as in single precision. Their eight
// significant ones are enough for a preconditioner, whose Krylov method runs in double precision;
// arithmetic is in single precision. Calls of BLAS would cost more than both.
//
// Two threads take the two branches of the elimination tree, then one what both contribute to.
// Contributions are added up in one order, so results do not depend on the number of threads.
class SupernodalFactor {
 public:
  using Real = float;
  using Stored = std::uint16_t;  // bfloat16: the upper half of a float

  explicit SupernodalFactor(std::shared_ptr<const SupernodalStructure> structure);

  // Factorises the matrix with these CSR values in place of any earlier one. false if it is not
  // positive definite; there is no factor then.
  bool factorise(const std::vector<double>& values);

  // x = A⁻¹ b to the precision of the factor. Threads may solve at the same time, each with its own
  // work.
  struct Work {
    std::vector<Real> x;
    std::vector<Real> dense[2], above[2];  // of each branch: a supernode's rows; sums for the top
  };
  void solve(ConstVec b, VecRef x, const ThreadTeam& team, Work& work) const;

 private:
  void keep(std::size_t supernode, const float* columns);
  void forward(int supernode, Real* x, Real* above, Real* work) const;
  void backward(int supernode, Real* x, Real* work) const;

  std::shared_ptr<const SupernodalStructure> structure_;
  std::vector<std::size_t> value_begin_;  // of each supernode's groups of columns; the end
  std::vector<Stored> values_;
};

}  // namespace traceraft
