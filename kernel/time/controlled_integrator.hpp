// The common part, all but the step, of methods that control steps by an estimate of the error.
#pragma once

#include <memory>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/time/energy_guard.hpp"
#include "kernel/time/integrator.hpp"
#include "kernel/time/jacobian_solver.hpp"
#include "kernel/time/state_history.hpp"
#include "kernel/time/step_control.hpp"

namespace traceraft::time {

// Derived classes attempt steps; this one sizes, repeats, judges and accepts them, keeps the states
// for interpolation, and saves and loads.
class ControlledIntegrator : public Integrator {
 public:
  Status start(double t0, VecView y0, VecView ydot0, double t_end) override;
  Status advance() final;
  Status interpolate(double t, VecRef y) const final;

  double time() const final { return history_.time(0); }
  double step() const final { return step_; }
  double next_step() const final { return next_; }
  const Vec& state() const final { return history_.state(0); }

  IntegratorStatistics statistics() const final;
  linear::LinearStatistics linear_statistics() const final { return solver_.linear_statistics(); }
  void save(CheckpointOut out) const override;
  void load(CheckpointIn in) override;

 protected:
  // The estimated error grows like Δt^power; steps are interpolated to that order. The first one
  // changes the state by first_change · tolerance. The problem must outlive this object.
  ControlledIntegrator(const problem::DaeProblem& problem,
                       const linear::LinearSolverChoice& solvers, int lanes,
                       std::shared_ptr<const ThreadTeam> team, const IntegratorSettings& settings,
                       int power, double first_change);

  // One step from state() with its relative error; nothing is changed for good.
  virtual Status attempt(double dt, double& error) = 0;
  // The result of the last attempt, called once if its error is accepted.
  virtual Vec result() = 0;
  // Called before the result becomes the next state.
  virtual void accepted() = 0;

  const problem::DaeProblem& problem_;
  const IntegratorSettings settings_;
  JacobianSolver solver_;
  IntegratorStatistics statistics_;
  StateHistory history_;
  double step_ = 0;

 private:
  void make_control() { control_ = StepControl(settings_, span_, power_, problem_.longest_step()); }
  Status judged_attempt(double dt, double& error);

  int power_;
  double first_change_;
  StepControl control_;
  EnergyGuard guard_;
  Vec proposal_;
  double t_end_ = 0, span_ = 0, next_ = 0;
};

}  // namespace traceraft::time
