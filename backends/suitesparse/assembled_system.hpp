// The Jacobian as one sparse matrix, in the arrangement that direct solvers like.
#pragma once

#include <vector>

#include "kernel/linear/block_jacobian.hpp"

namespace traceraft::suitesparse {

// The system, with A = cm, B = −mc and μ = √σ ν:
//   [ B     −√σ M̃ ] [δc]   [ −b₂    ]
//   [ √σ M̃   A    ] [δν] = [ b₁/√σ  ]
// which is quasi-definite for the stabilised tangent: any symmetric pivot order is stable, so a
// fill-reducing order of the n×n pattern, expanded to (c, μ) pairs, can be kept. (The exact tangent
// adds the derivative of the mobility to M̃ in the second row.) The arrangement [σM̃ A; −B M̃] needs
// ten times the time and memory for long steps.
class AssembledSystem {
 public:
  explicit AssembledSystem(fem::PatternPtr pattern) : pattern_(std::move(pattern)) {}

  int size() const { return 2 * pattern_->rows(); }
  // Compressed rows; that is, compressed columns of the transpose.
  int* begin() { return begin_.data(); }
  int* index() { return index_.data(); }
  double* values() { return values_.data(); }

  void fill(const linear::BlockJacobian& J);  // σ > 0
  Vec right_side(const linear::BlockJacobian& J, VecView b) const;
  // x of the block system from a solution of this one, with the mass of b restored.
  void take_solution(const linear::BlockJacobian& J, VecView b, VecView solution, VecRef x) const;

 private:
  void build_rows();

  fem::PatternPtr pattern_;
  std::vector<int> begin_, index_;
  std::vector<double> values_;
};

}  // namespace traceraft::suitesparse
