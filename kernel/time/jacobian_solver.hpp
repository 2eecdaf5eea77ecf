// Solves with Jacobians of a DAE and decides when to renew factors and when to fall back.
#pragma once

#include <vector>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/linear/linear_solver.hpp"
#include "kernel/problem/dae_problem.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::time {

// J(t, y, ẏ, σ) x = b, where J is the given tangent.
struct NewtonSystem {
  double t = 0, shift = 0;
  linear::Tangent tangent = linear::Tangent::exact;
  Vec y, ydot;
  Vec b;
  Vec x;  // initial guess in, solution out
  linear::SolveReport report;
};

struct JacobianSolverStatistics {
  long jacobians = 0;
  long renewals = 0;   // solves that failed with old factors and were repeated with fresh ones
  long fallbacks = 0;  // solves that the second solver had to do
  double assembly_seconds = 0;
};

// Solves up to `lanes` systems at the same time, one per thread of the team. Remembers at which
// state the factors in use were computed (the anchor), so that a restart can recompute them and go
// on bitwise like the run that wrote the checkpoint.
class JacobianSolver {
 public:
  // The problem must outlive this object.
  JacobianSolver(const problem::DaeProblem& problem, const linear::LinearSolverChoice& choice,
                 int lanes, std::shared_ptr<const ThreadTeam> team);

  // Solves the systems, at most `lanes`. For each it tries, in this order: the factors at hand,
  // fresh ones, the fallback. A report of retry gives every reason.
  void solve(std::vector<NewtonSystem>& systems, double tolerance);

  // Solves with the Jacobians of the last call, whatever the states of the systems.
  void solve_again(std::vector<NewtonSystem>& systems, double tolerance);

  linear::LinearStatistics linear_statistics() const;
  // An integrator's statistics with what happened here.
  IntegratorStatistics added_to(IntegratorStatistics statistics) const;
  const JacobianSolverStatistics& statistics() const { return statistics_; }
  void save(CheckpointOut out) const;
  void load(CheckpointIn in);

 private:
  // The state at which a Jacobian was assembled.
  struct Origin {
    double t = 0, shift = 0;
    linear::Tangent tangent = linear::Tangent::exact;
    Vec y, ydot;
  };
  template <class Action>
  void for_each_lane(std::size_t count, const Action& action);
  void assemble(std::vector<NewtonSystem>& systems);
  Status renew(int lane);
  void solve_assembled(std::vector<NewtonSystem>& systems, double tolerance, bool new_jacobians);
  void solve_with(linear::LinearSolver& solver, NewtonSystem& system, double tolerance, int lane);
  void solve_with_factors(std::vector<NewtonSystem>& systems, double tolerance, bool fresh);
  void repair(NewtonSystem& system, const Vec& guess, int lane, double tolerance, bool fresh);

  const problem::DaeProblem& problem_;
  linear::LinearSolverPtr primary_, fallback_;
  std::shared_ptr<const ThreadTeam> team_;
  std::vector<linear::BlockJacobian> J_;  // per lane
  std::vector<Origin> origins_;           // per lane
  Origin anchor_;          // of the factors in use, if they outlive a call: shared ones
  bool anchored_ = false;  // the primary holds usable shared factors, made at the anchor
  JacobianSolverStatistics statistics_;
};

}  // namespace traceraft::time
