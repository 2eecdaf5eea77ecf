#include "kernel/time/jacobian_solver.hpp"

#include "kernel/core/stopwatch.hpp"

namespace traceraft::time {

JacobianSolver::JacobianSolver(const problem::DaeProblem& problem,
                               const linear::LinearSolverChoice& choice, int lanes,
                               std::shared_ptr<const ThreadTeam> team)
    : problem_(problem),
      primary_(choice.primary(lanes)),
      fallback_(choice.fallback ? choice.fallback(lanes) : nullptr),
      team_(std::move(team)),
      J_(static_cast<std::size_t>(lanes), problem.make_jacobian()),
      origins_(static_cast<std::size_t>(lanes)) {}

template <class Action>
void JacobianSolver::for_each_lane(std::size_t count, const Action& action) {
  // One lane has the whole team for itself; several share it, each on its own thread.
  if (count == 1) return action(0);
  team_->run([&](int part) {
    for (std::size_t lane = part; lane < count; lane += team_->size())
      action(static_cast<int>(lane));
  });
}

void JacobianSolver::assemble(std::vector<NewtonSystem>& systems) {
  const ScopedTimer timer(statistics_.assembly_seconds);
  for_each_lane(systems.size(), [&](int lane) {
    NewtonSystem& s = systems[lane];
    s.report = {problem_.jacobian(s.t, s.y, s.ydot, s.shift, s.tangent, J_[lane])};
    origins_[lane] = {s.t, s.shift, s.tangent, s.y, s.ydot};
  });
  statistics_.jacobians += static_cast<long>(systems.size());
}

Status JacobianSolver::renew(int lane) {
  const Status status = primary_->setup(J_[lane], lane);
  if (primary_->shares_factors()) {
    anchor_ = origins_[lane];
    anchored_ = status.ok();
  }
  return status;
}

// Whatever a solver says: error estimates look at c only, and μ must be a number, too.
void JacobianSolver::solve_with(linear::LinearSolver& solver, NewtonSystem& system,
                                double tolerance, int lane) {
  system.report = solver.solve(J_[lane], system.b, system.x, tolerance, lane);
  if (system.report.status.ok() && !problem_.ranks().all(system.x.allFinite()))
    system.report.status = Status::retry("the solution is not finite");
}

void JacobianSolver::solve_with_factors(std::vector<NewtonSystem>& systems, double tolerance,
                                        bool fresh) {
  for_each_lane(systems.size(), [&](int lane) {
    NewtonSystem& s = systems[lane];
    if (fresh && !primary_->shares_factors()) s.report.status = primary_->setup(J_[lane], lane);
    if (s.report.status.ok()) solve_with(*primary_, s, tolerance, lane);
  });
}

// A system that failed at the same time as others is repeated alone.
void JacobianSolver::repair(NewtonSystem& system, const Vec& guess, int lane, double tolerance,
                            bool fresh) {
  if (!fresh) {
    ++statistics_.renewals;
    system.x = guess;
    system.report.status = renew(lane);
    if (system.report.status.ok()) solve_with(*primary_, system, tolerance, lane);
    if (system.report.status.ok()) return;
  }
  const std::string why = primary_->name() + ": " + system.report.status.why;
  if (!fallback_) {
    system.report.status = Status::retry(why);
    return;
  }
  ++statistics_.fallbacks;
  system.x = guess;
  system.report = {fallback_->setup(J_[lane], lane)};
  if (system.report.status.ok()) solve_with(*fallback_, system, tolerance, lane);
  if (!system.report.status.ok())
    system.report.status =
        Status::retry(why + "; " + fallback_->name() + ": " + system.report.status.why);
}

void JacobianSolver::solve(std::vector<NewtonSystem>& systems, double tolerance) {
  assemble(systems);
  for (const NewtonSystem& system : systems)
    if (!system.report.status.ok()) return;
  solve_assembled(systems, tolerance, true);
}

void JacobianSolver::solve_again(std::vector<NewtonSystem>& systems, double tolerance) {
  for (NewtonSystem& system : systems) system.report = {};
  solve_assembled(systems, tolerance, false);
}

void JacobianSolver::solve_assembled(std::vector<NewtonSystem>& systems, double tolerance,
                                     bool new_jacobians) {
  std::vector<Vec> guesses;
  for (const NewtonSystem& system : systems) guesses.push_back(system.x);

  bool fresh = new_jacobians && !primary_->shares_factors();
  if (primary_->shares_factors() && (!anchored_ || primary_->wants_setup(J_[0], 0))) {
    fresh = true;
    if (Status status = renew(0); !status.ok())
      for (NewtonSystem& system : systems) system.report.status = status;
  }
  solve_with_factors(systems, tolerance, fresh);
  for (std::size_t lane = 0; lane < systems.size(); ++lane)
    if (!systems[lane].report.status.ok())
      repair(systems[lane], guesses[lane], static_cast<int>(lane), tolerance, fresh);
}

linear::LinearStatistics JacobianSolver::linear_statistics() const {
  return fallback_ ? primary_->statistics() + fallback_->statistics() : primary_->statistics();
}

IntegratorStatistics JacobianSolver::added_to(IntegratorStatistics statistics) const {
  statistics.jacobians += statistics_.jacobians;
  statistics.fallbacks += statistics_.fallbacks;
  statistics.renewals += statistics_.renewals;
  statistics.assembly_seconds += statistics_.assembly_seconds;
  return statistics;
}

void JacobianSolver::save(CheckpointOut out) const {
  write_binary(out, statistics_);
  write_binary(out, anchored_);
  if (anchored_) {
    write_binary(out, anchor_.t);
    write_binary(out, anchor_.shift);
    write_binary(out, anchor_.tangent);
    write_binary(out, anchor_.y);
    write_binary(out, anchor_.ydot);
  }
  primary_->save(out);
  if (fallback_) fallback_->save(out);
}

void JacobianSolver::load(CheckpointIn in) {
  read_binary(in, statistics_);
  read_binary(in, anchored_);
  if (anchored_) {
    Origin& origin = origins_[0];
    read_binary(in, origin.t);
    read_binary(in, origin.shift);
    read_binary(in, origin.tangent);
    read_binary(in, origin.y, problem_.size());
    read_difference(in, origin.ydot, problem_.size());
    Status status =
        problem_.jacobian(origin.t, origin.y, origin.ydot, origin.shift, origin.tangent, J_[0]);
    if (status.ok()) status = renew(0);
    if (!status.ok()) throw IoError("checkpoint: its factors cannot be recomputed: " + status.why);
  }
  primary_->load(in);
  if (fallback_) fallback_->load(in);
}

}  // namespace traceraft::time
