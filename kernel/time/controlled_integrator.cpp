#include "kernel/time/controlled_integrator.hpp"

#include <cmath>
#include <utility>

namespace traceraft::time {

ControlledIntegrator::ControlledIntegrator(const problem::DaeProblem& problem,
                                           const linear::LinearSolverChoice& solvers, int lanes,
                                           std::shared_ptr<const ThreadTeam> team,
                                           const IntegratorSettings& settings, int power,
                                           double first_change)
    : problem_(problem),
      settings_(settings),
      solver_(problem, solvers, lanes, std::move(team)),
      history_(static_cast<std::size_t>(power) + 1),
      power_(power),
      first_change_(first_change),
      guard_(problem, settings) {}

Status ControlledIntegrator::start(double t0, VecView y0, VecView ydot0, double t_end) {
  history_.clear();
  history_.add(t0, y0);
  guard_.start(y0);
  t_end_ = t_end;
  span_ = t_end - t0;
  make_control();
  const double change = first_change_ * settings_.tolerance * problem_.norm(y0);
  next_ = control_.bounded(first_step(settings_, span_, change, problem_.norm(ydot0)));
  return {};
}

Status ControlledIntegrator::advance() {
  return take_step(
      control_, time(), t_end_, next_, statistics_,
      [&](double dt, double& error) { return judged_attempt(dt, error); },
      [&](double dt, double t, double error) {
        guard_.accept();
        accepted();
        history_.add(t, std::move(proposal_));
        step_ = dt;
        next_ = control_.after_acceptance(dt, error);
        ++statistics_.steps;
      });
}

Status ControlledIntegrator::judged_attempt(double dt, double& error) {
  if (Status status = attempt(dt, error); !status.ok()) return status;
  if (std::isnan(error)) return Status::retry("the error estimate is not a number");
  if (!control_.accepts(error)) return {};
  proposal_ = result();
  return guard_.judge(proposal_);
}

Status ControlledIntegrator::interpolate(double t, VecRef y) const {
  if (!(history_.size() > 1 && t >= history_.time(1) && t <= time()))
    return Status::fatal("interpolation outside the last step");
  history_.interpolate(t, y);
  return {};
}

IntegratorStatistics ControlledIntegrator::statistics() const {
  IntegratorStatistics result = solver_.added_to(statistics_);
  result.energy_rises = guard_.refused();
  return result;
}

void ControlledIntegrator::save(CheckpointOut out) const {
  for (const double value : {t_end_, span_, step_, next_}) write_binary(out, value);
  history_.save(out);
  write_binary(out, statistics_);
  guard_.save(out);
  solver_.save(out);
}

void ControlledIntegrator::load(CheckpointIn in) {
  for (double* value : {&t_end_, &span_, &step_, &next_}) read_binary(in, *value);
  history_.load(in, problem_.size());
  if (history_.size() == 0) throw IoError("checkpoint: it holds no state");
  read_binary(in, statistics_);
  guard_.load(in, history_.state(0));
  make_control();
  solver_.load(in);
}

}  // namespace traceraft::time
