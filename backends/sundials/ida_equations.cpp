#include "backends/sundials/ida_equations.hpp"

#include <ida/ida.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

#include "backends/sundials/state_vector.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft::sundials {

IdaEquations::IdaEquations(const problem::DaeProblem& problem,
                           const linear::LinearSolverChoice& solvers,
                           std::shared_ptr<const ThreadTeam> team, const IdaSettings& settings)
    : problem_(problem),
      settings_(settings),
      guard_(problem, settings.general()),
      solver_(problem, solvers, 1, std::move(team)),
      systems_(1) {}

void IdaEquations::attach(void* memory, double t0, N_Vector y, N_Vector ydot, SUNContext context) {
  const auto must = [&](int flag) {
    if (flag != IDA_SUCCESS) throw std::runtime_error("IDA: " + message_);
  };
  memory_ = memory;
  work_.reset(N_VClone(y));
  unit_ = problem_.field_norm(Vec::Ones(problem_.size() / 2));
  must(IDASetErrHandlerFn(memory, on_error, this));
  must(IDAInit(memory, residual, t0, y, ydot));
  must(IDASetUserData(memory, this));
  must(IDAWFtolerances(memory, error_weights));
  make_linear_solver(context);
  must(IDASetLinearSolver(memory, linear_.get(), nullptr));
  newton_.reset(SUNNonlinSol_Newton(y, context));
  if (!newton_) throw std::bad_alloc();
  must(IDASetNonlinearSolver(memory, newton_.get()));
  SUNNonlinSolSetConvTestFn(newton_.get(), converged, this);
}

void IdaEquations::detach() {
  newton_.reset();
  linear_.reset();
  work_.reset();
  memory_ = nullptr;
}

void IdaEquations::forget_complaints() {
  message_.clear();
  why_.clear();
}

void IdaEquations::throw_again() {
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

time::IntegratorStatistics IdaEquations::added_to(time::IntegratorStatistics statistics) const {
  statistics.energy_rises = guard_.refused();
  statistics.residuals = residuals_;
  statistics.assembly_seconds = residual_seconds_;
  return solver_.added_to(statistics);
}

void IdaEquations::save_residuals(CheckpointOut out) const {
  write_binary(out, residual_seconds_);
  write_binary(out, residuals_);
}

void IdaEquations::load_residuals(CheckpointIn in) {
  read_binary(in, residual_seconds_);
  read_binary(in, residuals_);
}

void IdaEquations::save(CheckpointOut out) const {
  newton_test_.save(out);
  guard_.save(out);
  solver_.save(out);
}

void IdaEquations::load(CheckpointIn in, VecView y) {
  newton_test_.load(in);
  guard_.load(in, y);
  solver_.load(in);
}

// IDA asks nothing of a "matrix-embedded" solver but to solve with the current iterate.
void IdaEquations::make_linear_solver(SUNContext context) {
  linear_.reset(SUNLinSolNewEmpty(context));
  if (!linear_) throw std::bad_alloc();
  linear_->content = this;
  linear_->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_MATRIX_EMBEDDED; };
  linear_->ops->getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
  linear_->ops->initialize = [](SUNLinearSolver) -> int { return SUNLS_SUCCESS; };
  linear_->ops->solve = solve;
  linear_->ops->numiters = [](SUNLinearSolver s) {
    return std::max(1, static_cast<IdaEquations*>(s->content)->systems_[0].report.iterations);
  };
  linear_->ops->resid = [](SUNLinearSolver s) {
    return static_cast<IdaEquations*>(s->content)->work_.get();
  };
  linear_->ops->resnorm = [](SUNLinearSolver) { return 0.0; };
}

int IdaEquations::converged(SUNNonlinearSolver newton, N_Vector total, N_Vector correction,
                            double bound, N_Vector weights, void* data) {
  auto& self = *static_cast<IdaEquations*>(data);
  int iteration = 0;
  SUNNonlinSolGetCurIter(newton, &iteration);
  switch (self.newton_test_.judge(iteration, N_VWrmsNorm(correction, weights), bound)) {
    case NewtonTest::Verdict::converged:
      return self.permits(total) ? SUN_NLS_SUCCESS : SUN_NLS_CONV_RECVR;
    case NewtonTest::Verdict::go_on:
      return SUN_NLS_CONTINUE;
    default:
      return SUN_NLS_CONV_RECVR;
  }
}

// May the predictor with this total correction become the next state? If not, IDA retries with a
// smaller step, as if Newton's method had failed.
bool IdaEquations::permits(N_Vector total) {
  if (!guard_.active()) return true;
  const int refused = guarded(1, [&] {
    IDAComputeY(memory_, total, work_.get());
    return code(guard_.judge(view(work_.get())), 1, 1);
  });
  return refused == 0;
}

// The code that tells IDA of a status. It is a listed one: 6.4 takes any other for success.
int IdaEquations::code(const Status& status, int retry, int fatal) {
  why_ = status.why;
  if (status.ok()) return 0;
  return status.outcome == Outcome::retry ? retry : fatal;
}

// Runs `action` behind the C boundary: an exception is kept until throw_again().
template <class Action>
int IdaEquations::guarded(int fatal, const Action& action) noexcept {
  try {
    return action();
  } catch (...) {
    thrown_ = std::current_exception();
    return fatal;
  }
}

int IdaEquations::residual(double t, N_Vector y, N_Vector ydot, N_Vector r, void* data) {
  auto& self = *static_cast<IdaEquations*>(data);
  return self.guarded(-1, [&] {
    const ScopedTimer timer(self.residual_seconds_);
    ++self.residuals_;
    return self.code(self.problem_.residual(t, view(y), view(ydot), view(r)), 1, -1);
  });
}

int IdaEquations::error_weights(N_Vector y, N_Vector weights, void* data) {
  auto& self = *static_cast<IdaEquations*>(data);
  return self.guarded(-1, [&] {
    const Eigen::Index n = self.problem_.block_size();
    const double floor = self.settings_.atol() * self.unit_, rtol = self.settings_.rtol();
    const auto set = [&](Eigen::Index half) {
      view(weights).segment(half, n).setConstant(
          1 / (rtol * self.problem_.field_norm(view(y).segment(half, n)) + floor));
    };
    set(0);
    // Newton's method is judged by what the error test is about.
    if (self.settings_.option("suppressalg") != 0) {
      view(weights).tail(n).setZero();
    } else {
      set(n);
    }
    return 0;
  });
}

int IdaEquations::solve(SUNLinearSolver linear, SUNMatrix, N_Vector x, N_Vector b, double) {
  auto& self = *static_cast<IdaEquations*>(linear->content);
  return self.guarded(SUNLS_PACKAGE_FAIL_UNREC, [&] {
    N_Vector y = nullptr, ydot = nullptr;
    time::NewtonSystem& system = self.systems_[0];
    IDAGetCurrentTime(self.memory_, &system.t);
    IDAGetCurrentY(self.memory_, &y);
    IDAGetCurrentYp(self.memory_, &ydot);
    IDAGetCurrentCj(self.memory_, &system.shift);
    system.tangent = linear::Tangent::exact;
    system.y = view(y);
    system.ydot = view(ydot);
    system.b = view(b);
    system.x = Vec::Zero(system.b.size());
    int correction = 0;
    SUNNonlinSolGetCurIter(self.newton_.get(), &correction);
    self.solver_.solve(self.systems_, self.settings_.linear_tolerance(correction));
    view(x) = system.x;
    return self.code(system.report.status, SUNLS_PACKAGE_FAIL_REC, SUNLS_PACKAGE_FAIL_UNREC);
  });
}

void IdaEquations::on_error(int code, const char*, const char*, char* text, void* data) {
  if (code < 0) static_cast<IdaEquations*>(data)->message_ = text;
}

}  // namespace traceraft::sundials
