// The equations as IDA asks for them while it takes a step: the residual, the solution of Newton's
// linear systems, the weights of its norm and whether Newton's method has converged.
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "backends/sundials/ida_settings.hpp"
#include "backends/sundials/newton_test.hpp"
#include "backends/sundials/owned.hpp"
#include "kernel/time/energy_guard.hpp"
#include "kernel/time/jacobian_solver.hpp"

namespace traceraft::sundials {

// One at a time belongs to a memory of IDA. IDA's C functions carry neither exceptions nor the
// reasons of a status: both are kept here until the step is over.
class IdaEquations {
 public:
  // Problem and settings must outlive this object.
  IdaEquations(const problem::DaeProblem& problem, const linear::LinearSolverChoice& solvers,
               std::shared_ptr<const ThreadTeam> team, const IdaSettings& settings);
  IdaEquations(const IdaEquations&) = delete;
  IdaEquations& operator=(const IdaEquations&) = delete;

  // Makes these the equations of a new memory, from y and ẏ at t0 on. Throws std::runtime_error.
  void attach(void* memory, double t0, N_Vector y, N_Vector ydot, SUNContext context);
  // To be called when the memory is gone, and before the context is.
  void detach();

  // Before a step of IDA and after it: what a callback threw is thrown again.
  void forget_complaints();
  void throw_again();
  // The reason why a callback failed, or IDA's own complaint, "" if there is none.
  std::string complaint() const {
    return why_.empty() && !message_.empty() ? message_ + " (its times are in R^2/D)" : why_;
  }
  const std::string& message() const { return message_; }

  // The energy guard: y begins the run; the state judged last is accepted.
  void start(VecView y) { guard_.start(y); }
  void accept() { guard_.accept(); }

  // An integrator's statistics with what happened here.
  time::IntegratorStatistics added_to(time::IntegratorStatistics statistics) const;
  linear::LinearStatistics linear_statistics() const { return solver_.linear_statistics(); }

  // Everything that the next step depends on, for a memory that this is attached to. y: the state
  // that goes on.
  void save(CheckpointOut out) const;
  void load(CheckpointIn in, VecView y);
  // The number of residuals and the time spent on them: checkpoints have both before the memory.
  void save_residuals(CheckpointOut out) const;
  void load_residuals(CheckpointIn in);

 private:
  static int residual(double t, N_Vector y, N_Vector ydot, N_Vector r, void* data);
  static int error_weights(N_Vector y, N_Vector weights, void* data);
  static int solve(SUNLinearSolver linear, SUNMatrix, N_Vector x, N_Vector b, double);
  static int converged(SUNNonlinearSolver newton, N_Vector total, N_Vector correction, double bound,
                       N_Vector weights, void* data);
  static void on_error(int code, const char*, const char*, char* text, void* data);
  void make_linear_solver(SUNContext context);
  bool permits(N_Vector total);
  int code(const Status& status, int retry, int fatal);
  template <class Action>
  int guarded(int fatal, const Action& action) noexcept;

  const problem::DaeProblem& problem_;
  const IdaSettings& settings_;
  time::EnergyGuard guard_;
  time::JacobianSolver solver_;
  NewtonTest newton_test_;
  std::vector<time::NewtonSystem> systems_;
  void* memory_ = nullptr;
  VectorPtr work_;
  LinearPtr linear_;
  NewtonPtr newton_;
  double unit_ = 1;  // norm of the field 1
  double residual_seconds_ = 0;
  long residuals_ = 0;         // and their number
  std::string message_, why_;  // IDA's last complaint, and what made a callback fail
  std::exception_ptr thrown_;
};

}  // namespace traceraft::sundials
