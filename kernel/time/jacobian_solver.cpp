#include "kernel/time/jacobian_solver.hpp"

#include "kernel/core/binary.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft {

JacobianSolver::JacobianSolver(const DaeProblem& problem, const LinearSolverChoice& choice)
    : problem_(problem),
      primary_(choice.primary()),
      fallback_(choice.fallback ? choice.fallback() : nullptr),
      J_(problem.make_jacobian()) {}

Status JacobianSolver::renew(double t, ConstVec y, ConstVec ydot, double shift, Tangent tangent) {
  anchor_.t = t;
  anchor_.shift = shift;
  anchor_.tangent = tangent;
  anchor_.y = y;
  anchor_.ydot = ydot;
  const Status status = primary_->setup(J_);
  ready_ = status.ok();
  return status;
}

SolveReport JacobianSolver::solve(double t, ConstVec y, ConstVec ydot, double shift,
                                  Tangent tangent, ConstVec b, VecRef x, double tolerance) {
  {
    const ScopedTimer timer(statistics_.assembly_seconds);
    ++statistics_.jacobians;
    if (Status status = problem_.jacobian(t, y, ydot, shift, tangent, J_); !status.ok())
      return {status};
  }
  const Vec guess = x;
  int iterations = 0;
  std::string why;
  if (ready_ && !primary_->wants_setup(J_)) {
    SolveReport report = primary_->solve(J_, b, x, tolerance);
    if (report.status.ok()) return report;
    ++statistics_.renewals;
    iterations += report.iterations;
    x = guess;
  }
  Status fresh = renew(t, y, ydot, shift, tangent);
  if (fresh.ok()) {
    SolveReport report = primary_->solve(J_, b, x, tolerance);
    report.iterations += iterations;
    if (report.status.ok()) return report;
    fresh = report.status;
  }
  why = primary_->name() + ": " + fresh.why;
  if (!fallback_) return {Status::retry(why), iterations};

  const ScopedTimer timer(statistics_.fallback_seconds);
  ++statistics_.fallbacks;
  x = guess;
  SolveReport report{fallback_->setup(J_)};
  if (report.status.ok()) report = fallback_->solve(J_, b, x, tolerance);
  if (!report.status.ok())
    report.status = Status::retry(why + "; " + fallback_->name() + ": " + report.status.why);
  return report;
}

LinearStatistics JacobianSolver::linear_statistics() const {
  return fallback_ ? primary_->statistics() + fallback_->statistics() : primary_->statistics();
}

void JacobianSolver::save(std::ostream& out) const {
  write_binary(out, statistics_);
  write_binary(out, ready_);
  if (ready_) {
    write_binary(out, anchor_.t);
    write_binary(out, anchor_.shift);
    write_binary(out, anchor_.tangent);
    write_binary(out, anchor_.y);
    write_binary(out, anchor_.ydot);
  }
  primary_->save(out);
  if (fallback_) fallback_->save(out);
}

void JacobianSolver::load(std::istream& in) {
  JacobianSolverStatistics statistics;
  read_binary(in, statistics);
  read_binary(in, ready_);
  if (ready_) {
    Anchor anchor;
    read_binary(in, anchor.t);
    read_binary(in, anchor.shift);
    read_binary(in, anchor.tangent);
    read_binary(in, anchor.y, problem_.size());
    read_binary(in, anchor.ydot, problem_.size());
    Status status =
        problem_.jacobian(anchor.t, anchor.y, anchor.ydot, anchor.shift, anchor.tangent, J_);
    if (status.ok()) status = renew(anchor.t, anchor.y, anchor.ydot, anchor.shift, anchor.tangent);
    if (!status.ok()) throw IoError("checkpoint: its factors cannot be recomputed: " + status.why);
  }
  primary_->load(in);
  if (fallback_) fallback_->load(in);
  statistics_ = statistics;
}

}  // namespace traceraft
