#include "backends/sundials/spfgmr.hpp"

#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_spfgmr.h>

#include <cmath>
#include <exception>
#include <stdexcept>

#include "backends/sundials/state_vector.hpp"

namespace traceraft::sundials {
namespace {

constexpr int kRestart = 50;

// GMRES takes no weighted norms.
const StateSpace plain{nullptr, kAlone};

// The operators of one solve; an exception stops at the C boundary and is thrown again after it.
struct Operators {
  const linear::LinearOperator& A;
  const linear::LinearOperator& preconditioner;
  std::exception_ptr thrown;

  int apply(const linear::LinearOperator& op, N_Vector in, N_Vector out) noexcept {
    try {
      const Status status = op(view(in), view(out));
      return status.ok() ? 0 : status.outcome == Outcome::retry ? 1 : -1;
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }
};

int times(void* data, N_Vector in, N_Vector out) {
  auto* operators = static_cast<Operators*>(data);
  return operators->apply(operators->A, in, out);
}

int precondition(void* data, N_Vector in, N_Vector out, double, int) {
  auto* operators = static_cast<Operators*>(data);
  return operators->apply(operators->preconditioner, in, out);
}

class Spfgmr final : public linear::KrylovMethod {
 public:
  explicit Spfgmr(int size) {
    if (SUNContext_Create(nullptr, &context_) != 0)
      throw std::runtime_error("SUNDIALS: no context");
    right_ = new_state_vector(size, plain, context_);
    solution_ = new_state_vector(size, plain, context_);
    solver_ = SUNLinSol_SPFGMR(solution_, SUN_PREC_RIGHT, kRestart, context_);
    if (!solver_) throw std::bad_alloc();
    SUNLinSol_SPFGMRSetGSType(solver_, SUN_CLASSICAL_GS);
  }
  ~Spfgmr() override {
    SUNLinSolFree(solver_);
    N_VDestroy(right_);
    N_VDestroy(solution_);
    SUNContext_Free(&context_);
  }

  linear::SolveReport solve(const linear::LinearOperator& A,
                            const linear::LinearOperator& preconditioner, VecView b, VecRef x,
                            double tolerance, int max_iterations) override {
    Operators operators{A, preconditioner, nullptr};
    const double norm = std::sqrt(fem::dot(b, b));
    if (norm == 0) {
      x.setZero();
      return {};
    }
    if (!std::isfinite(norm)) return {Status::retry("GMRES: the right-hand side is not finite")};
    view(right_) = b;
    view(solution_) = x;
    SUNLinSolSetATimes(solver_, &operators, times);
    SUNLinSolSetPreconditioner(solver_, &operators, nullptr, precondition);
    SUNLinSol_SPFGMRSetMaxRestarts(solver_, (max_iterations + kRestart - 1) / kRestart - 1);
    SUNLinSolInitialize(solver_);
    SUNLinSolSetZeroGuess(solver_, x.isZero(0));
    const int flag = SUNLinSolSolve(solver_, nullptr, solution_, right_, tolerance * norm);
    if (operators.thrown) std::rethrow_exception(operators.thrown);
    const int iterations = SUNLinSolNumIters(solver_);
    x = view(solution_);
    // Anything but plain success, a merely reduced residual included, is no solution.
    if (flag != SUNLS_SUCCESS)
      return {Status::retry("GMRES: no convergence in " + std::to_string(iterations) +
                            " iterations (SUNDIALS code " + std::to_string(flag) + ")"),
              iterations};
    return {{}, iterations};
  }

 private:
  SUNContext context_ = nullptr;
  N_Vector right_ = nullptr, solution_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
};

}  // namespace

std::unique_ptr<linear::KrylovMethod> make_spfgmr(int size) {
  return std::make_unique<Spfgmr>(size);
}

}  // namespace traceraft::sundials
