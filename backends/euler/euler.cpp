#include "backends/euler/euler.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "kernel/core/binary.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/time/jacobian_solver.hpp"
#include "kernel/time/step_control.hpp"

namespace traceraft {
namespace {

constexpr double kLinearTolerance = 1e-4;

class Euler final : public Integrator {
 public:
  Euler(const DaeProblem& problem, const LinearSolverChoice& solvers,
        std::shared_ptr<const ThreadTeam> team, const IntegratorSettings& settings)
      : problem_(problem), settings_(settings), solver_(problem, solvers, 2, std::move(team)) {}

  std::string name() const override { return "euler"; }

  Status start(double t0, ConstVec y0, ConstVec ydot0, double t_end) override {
    t_ = t0;
    t_end_ = t_end;
    y_ = y0;
    energy_ = problem_.energy(y_);
    rate_ = ydot0;
    span_ = t_end - t0;
    control_ = StepControl(settings_, span_, 2);
    const double rate = problem_.norm(rate_), size = problem_.norm(y_);
    // Small enough that the whole change of the first step is below the tolerance.
    double first = settings_.initial_step;
    if (!(first > 0)) first = rate > 0 ? 0.1 * settings_.tolerance * size / rate : t_end - t0;
    next_ = control_.bounded(std::min(first, t_end - t0));
    return {};
  }

  Status advance() override {
    return take_step(
        control_, t_, t_end_, next_, statistics_,
        [&](double dt, double& error) { return attempt(dt, error); },
        [&](double dt, double t, double error) { accept(dt, t, error); });
  }

  Status interpolate(double t, VecRef y) const override {
    if (!(t >= t_ - step_ && t <= t_)) return Status::fatal("interpolation outside the last step");
    const double x = t - t_;  // Lagrange through (0, y_), (−step, previous_), (−step − before, …)
    const double a = step_, b = step_ + step_before_;
    if (steps_kept_ < 2) {
      y = y_ + x / a * (y_ - previous_);
      return {};
    }
    const double w1 = -x * (x + b) / (a * (b - a)), w2 = x * (x + a) / (b * (b - a));
    y = y_ + w1 * (previous_ - y_) + w2 * (before_ - y_);
    return {};
  }

  double time() const override { return t_; }
  double step() const override { return step_; }
  double next_step() const override { return next_; }
  const Vec& state() const override { return y_; }
  bool promises_energy_decay() const override {
    return problem_.dissipates_energy() && settings_.kept_solution != "second";
  }

  IntegratorStatistics statistics() const override { return solver_.added_to(statistics_); }
  LinearStatistics linear_statistics() const override { return solver_.linear_statistics(); }

  void save(std::ostream& out) const override {
    write_binary(out, std::int64_t{steps_kept_});
    for (const double value : {t_, t_end_, span_, step_, step_before_, next_})
      write_binary(out, value);
    for (const Vec* vector : {&y_, &rate_}) write_binary(out, *vector);
    if (steps_kept_ > 0) write_binary(out, previous_);
    if (steps_kept_ > 1) write_binary(out, before_);
    write_binary(out, statistics_);
    solver_.save(out);
  }
  void load(std::istream& in) override {
    std::int64_t kept = 0;
    read_binary(in, kept);
    steps_kept_ = static_cast<int>(kept);
    for (double* value : {&t_, &t_end_, &span_, &step_, &step_before_, &next_})
      read_binary(in, *value);
    for (Vec* vector : {&y_, &rate_}) read_binary(in, *vector, problem_.size());
    if (steps_kept_ > 0) read_binary(in, previous_, problem_.size());
    if (steps_kept_ > 1) read_binary(in, before_, problem_.size());
    read_binary(in, statistics_);
    energy_ = problem_.energy(y_);
    control_ = StepControl(settings_, span_, 2);
    solver_.load(in);
  }

 private:
  // The second-order solution is the more accurate one; the first-order one never gains energy.
  bool keeps_second() {
    if (settings_.kept_solution != "decaying" || !problem_.dissipates_energy())
      return settings_.kept_solution != "first";
    const double second_energy = problem_.energy(second_);
    const bool decays = second_energy <= energy_;
    energy_ = decays ? second_energy : problem_.energy(first_);
    return decays;
  }

  // The system whose solution added to the predictor y is one of the two solutions of a step.
  static NewtonSystem correction(double t, double shift, Vec predictor, Vec rate) {
    NewtonSystem system;
    system.t = t;
    system.shift = shift;
    system.tangent = Tangent::stabilised;
    system.y = std::move(predictor);
    system.ydot = std::move(rate);
    system.x = Vec::Zero(system.y.size());
    return system;
  }

  Status evaluate_residuals() {
    const ScopedTimer timer(statistics_.assembly_seconds);
    for (NewtonSystem& system : systems_) {
      ++statistics_.residuals;
      system.b.resize(problem_.size());
      const Status status = problem_.residual(system.t, system.y, system.ydot, system.b);
      if (!status.ok()) return status;
      system.b = -system.b;
    }
    return {};
  }

  Status attempt(double dt, double& error) {
    const double t = t_ + dt, r = dt / step_;
    systems_.clear();
    systems_.push_back(correction(t, 1 / dt, y_, Vec::Zero(y_.size())));
    if (steps_kept_ > 0) {
      const Vec predictor = (1 + r) * y_ - r * previous_;
      const Vec rate =
          ((1 + 2 * r) / (1 + r) * predictor - (1 + r) * y_ + r * r / (1 + r) * previous_) / dt;
      systems_[0].x = predictor - y_;  // linear extrapolation is a good guess
      systems_.push_back(correction(t, (1 + 2 * r) / ((1 + r) * dt), predictor, rate));
    }
    if (Status status = evaluate_residuals(); !status.ok()) return status;
    solver_.solve(systems_,
                  settings_.linear_tolerance > 0 ? settings_.linear_tolerance : kLinearTolerance);
    for (const NewtonSystem& system : systems_)
      if (!system.report.status.ok()) return system.report.status;

    first_ = systems_[0].y + systems_[0].x;
    second_ = systems_.back().y + systems_.back().x;
    // At the start, half the difference to explicit Euler: the leading term of the local error.
    error = steps_kept_ > 0 ? problem_.norm(second_ - first_) / problem_.norm(second_)
                            : 0.5 * problem_.norm(first_ - y_ - dt * rate_) /
                                  std::max(problem_.norm(y_), 1e-300);
    if (first_ == second_ && steps_kept_ > 0) error = 0;  // c = 0 everywhere is 0/0
    if (std::isnan(error)) return Status::retry("the error estimate is not a number");
    return {};
  }

  void accept(double dt, double t, double error) {
    before_.swap(previous_);
    previous_.swap(y_);
    const bool second = keeps_second();
    y_ = second ? second_ : first_;
    statistics_.first_order += !second;
    statistics_.order = second && steps_kept_ > 0 ? 2 : 1;
    steps_kept_ = std::min(steps_kept_ + 1, 2);
    step_before_ = step_;
    step_ = dt;
    t_ = t;
    next_ = control_.after_acceptance(dt, error);
    ++statistics_.steps;
  }

  const DaeProblem& problem_;
  IntegratorSettings settings_;
  StepControl control_;
  IntegratorStatistics statistics_;
  double energy_ = 0;  // of y_n, where it decides which solution is kept
  double t_ = 0, t_end_ = 0, span_ = 0, step_ = 0, step_before_ = 0, next_ = 0;
  int steps_kept_ = 0;                // how many of previous_, before_ are filled
  Vec y_, previous_, before_, rate_;  // y_n, y_{n−1}, y_{n−2}, ẏ at the start
  JacobianSolver solver_;
  std::vector<NewtonSystem> systems_;  // of an attempt: first and second order
  Vec first_, second_;                 // and what they give
};

}  // namespace

IntegratorPtr make_euler(const DaeProblem& problem, const LinearSolverChoice& solvers,
                         std::shared_ptr<const ThreadTeam> team,
                         const IntegratorSettings& settings) {
  return std::make_unique<Euler>(problem, solvers, std::move(team), settings);
}

}  // namespace traceraft
