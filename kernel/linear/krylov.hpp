// The needs of the kernel's block solver from a library: an iterative method and a factorisation.
#pragma once

#include <functional>
#include <memory>

#include "kernel/core/status.hpp"
#include "kernel/fem/csr.hpp"
#include "kernel/linear/linear_solver.hpp"

namespace traceraft::linear {

// out = A in, or out = P⁻¹ in. retry if it cannot be applied.
using LinearOperator = std::function<Status(VecView in, VecRef out)>;

// A Krylov method with a right (flexible) preconditioner, so that the residual it stops on is the
// true one. ok only if ‖b − A x‖₂ ≤ tolerance · ‖b‖₂; x comes in as the initial guess, and is the
// last iterate in any case. Who asks for it looks at the residual, too.
class KrylovMethod {
 public:
  virtual ~KrylovMethod() = default;
  virtual SolveReport solve(const LinearOperator& A, const LinearOperator& preconditioner,
                            VecView b, VecRef x, double tolerance, int max_iterations) = 0;
};

// Factorises symmetric positive definite matrices of one pattern, again and again. Different
// objects may be used from different threads at the same time, and so may the lanes of solve.
class SpdSolver {
 public:
  virtual ~SpdSolver() = default;
  virtual Status factorise(const fem::CsrMatrix& A) = 0;  // retry: not positive definite
  // Uses the threads of the team, if it is not inside a task of it already.
  virtual void solve(VecView b, VecRef x, const ThreadTeam& team, int lane) = 0;
};

using KrylovFactory = std::function<std::unique_ptr<KrylovMethod>()>;
using SpdSolverPtr = std::unique_ptr<SpdSolver>;
using SpdSolverFactory = std::function<SpdSolverPtr(int lanes)>;

}  // namespace traceraft::linear
