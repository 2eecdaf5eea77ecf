// Solves with the Jacobian of a DAE and decides when to renew factors and when to fall back.
#pragma once

#include <iosfwd>

#include "kernel/linear/linear_solver.hpp"
#include "kernel/problem/dae_problem.hpp"

namespace traceraft {

struct JacobianSolverStatistics {
  long jacobians = 0;
  long renewals = 0;   // set-ups forced by a solve that failed with old factors
  long fallbacks = 0;  // solves that the second solver had to do
  double assembly_seconds = 0;
  double fallback_seconds = 0;
};

// Remembers at which state the factors in use were computed (the anchor), so that a restart can
// recompute them and go on bitwise like the run that wrote the checkpoint.
class JacobianSolver {
 public:
  // The problem must outlive this object.
  JacobianSolver(const DaeProblem& problem, const LinearSolverChoice& choice);

  // Solves J(t, y, ẏ, σ) x = b; x comes in as the initial guess. Tries, in this order: the factors
  // at hand, fresh ones, the fallback. retry: none of them worked, with every reason.
  SolveReport solve(double t, ConstVec y, ConstVec ydot, double shift, Tangent tangent, ConstVec b,
                    VecRef x, double tolerance);

  LinearStatistics linear_statistics() const;
  const JacobianSolverStatistics& statistics() const { return statistics_; }
  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Anchor {
    double t = 0, shift = 0;
    Tangent tangent = Tangent::exact;
    Vec y, ydot;
  };
  Status renew(double t, ConstVec y, ConstVec ydot, double shift, Tangent tangent);

  const DaeProblem& problem_;
  LinearSolverPtr primary_, fallback_;
  BlockJacobian J_;
  Anchor anchor_;
  bool ready_ = false;  // the primary holds usable factors
  JacobianSolverStatistics statistics_;
};

}  // namespace traceraft
