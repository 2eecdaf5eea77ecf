// Linear solvers and problems that fail where a test wants them to.
#pragma once

#include <cmath>
#include <functional>
#include <utility>

#include "tests/support/forwarding.hpp"

namespace traceraft::testing {

// A linear solver that fails on chosen calls.
class Faulty final : public ForwardingSolver {
 public:
  struct Plan {
    std::function<bool(long)> setup_fails = [](long) { return false; };
    std::function<bool(long)> solve_fails = [](long) { return false; };
    bool lazy = false;  // never asks for a set-up by itself
  };
  Faulty(linear::LinearSolverPtr inner, Plan plan)
      : ForwardingSolver(std::move(inner)), plan_(std::move(plan)) {}

  Status setup(const linear::BlockJacobian& J, int lane) override {
    if (plan_.setup_fails(setups_++)) return Status::retry("injected set-up failure");
    return ForwardingSolver::setup(J, lane);
  }
  bool wants_setup(const linear::BlockJacobian& J, int lane) const override {
    return !plan_.lazy && ForwardingSolver::wants_setup(J, lane);
  }
  linear::SolveReport solve(const linear::BlockJacobian& J, VecView b, VecRef x, double tolerance,
                            int lane) override {
    if (plan_.solve_fails(solves_++)) {
      x.setConstant(std::nan(""));  // as a failed solve may leave anything behind
      return {Status::retry("injected solve failure"), 3};
    }
    return ForwardingSolver::solve(J, b, x, tolerance, lane);
  }

 private:
  Plan plan_;
  long setups_ = 0, solves_ = 0;
};

// A problem whose residual is not a number from some evaluation on, or at all large steps.
class Poisoned final : public ForwardingProblem {
 public:
  Poisoned(const problem::DaeProblem& inner, std::function<bool(double)> poisoned_at)
      : ForwardingProblem(inner), poisoned_at_(std::move(poisoned_at)) {}
  Status residual(double t, VecView y, VecView ydot, VecRef r) const override {
    if (poisoned_at_(t) && !silent) return Status::retry("injected failure");
    const Status status = ForwardingProblem::residual(t, y, ydot, r);
    if (poisoned_at_(t)) r[r.size() / 3] = std::nan("");
    return status;
  }
  bool silent = false;  // a NaN that the model does not notice

 private:
  std::function<bool(double)> poisoned_at_;
};

}  // namespace traceraft::testing
