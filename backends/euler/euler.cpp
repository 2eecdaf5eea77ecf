#include "backends/euler/euler.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "kernel/core/binary.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/time/energy_guard.hpp"
#include "kernel/time/history.hpp"
#include "kernel/time/jacobian_solver.hpp"
#include "kernel/time/step_control.hpp"

namespace traceraft {
namespace {

constexpr double kLinearTolerance = 1e-4;

class Euler final : public Integrator {
 public:
  Euler(const DaeProblem& problem, const LinearSolverChoice& solvers,
        std::shared_ptr<const ThreadTeam> team, const IntegratorSettings& settings)
      : problem_(problem),
        settings_(settings),
        guard_(problem, settings),
        solver_(problem, solvers, 2, std::move(team)) {}

  std::string name() const override { return "euler"; }

  Status start(double t0, ConstVec y0, ConstVec ydot0, double t_end) override {
    history_.clear();
    history_.add(t0, y0);
    t_end_ = t_end;
    energy_ = problem_.energy(y0);
    guard_.start(y0);
    rate_ = ydot0;
    span_ = t_end - t0;
    control_ = StepControl(settings_, span_, 2);
    // A tenth of the tolerance is the whole change of the first step.
    const double change = 0.1 * settings_.tolerance * problem_.norm(y0);
    next_ = control_.bounded(first_step(settings_, span_, change, problem_.norm(rate_)));
    return {};
  }

  Status advance() override {
    return take_step(
        control_, time(), t_end_, next_, statistics_,
        [&](double dt, double& error) { return attempt(dt, error); },
        [&](double dt, double t, double error) { accept(dt, t, error); });
  }

  Status interpolate(double t, VecRef y) const override {
    if (!(history_.size() > 1 && t >= history_.time(1) && t <= time()))
      return Status::fatal("interpolation outside the last step");
    history_.interpolate(t, y);
    return {};
  }

  double time() const override { return history_.time(0); }
  double step() const override { return step_; }
  double next_step() const override { return next_; }
  const Vec& state() const override { return history_.state(0); }
  bool promises_energy_decay() const override {
    return problem_.dissipates_energy() && settings_.kept_solution != "second";
  }

  IntegratorStatistics statistics() const override {
    IntegratorStatistics result = solver_.added_to(statistics_);
    result.energy_rises = guard_.refused();
    return result;
  }
  LinearStatistics linear_statistics() const override { return solver_.linear_statistics(); }

  void save(std::ostream& out) const override {
    for (const double value : {t_end_, span_, step_, next_}) write_binary(out, value);
    history_.save(out);
    write_binary(out, rate_);
    write_binary(out, statistics_);
    guard_.save(out);
    solver_.save(out);
  }
  void load(std::istream& in) override {
    for (double* value : {&t_end_, &span_, &step_, &next_}) read_binary(in, *value);
    history_.load(in, problem_.size());
    read_binary(in, rate_, problem_.size());
    read_binary(in, statistics_);
    energy_ = problem_.energy(state());
    control_ = StepControl(settings_, span_, 2);
    guard_.load(in);
    solver_.load(in);
  }

 private:
  bool started() const { return history_.size() > 1; }

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
    const double t = time() + dt, r = dt / step_;
    const Vec& y = state();
    systems_.clear();
    systems_.push_back(correction(t, 1 / dt, y, Vec::Zero(y.size())));
    if (started()) {
      const Vec& previous = history_.state(1);
      const Vec predictor = (1 + r) * y - r * previous;
      const Vec rate =
          ((1 + 2 * r) / (1 + r) * predictor - (1 + r) * y + r * r / (1 + r) * previous) / dt;
      systems_[0].x = predictor - y;  // linear extrapolation is a good guess
      systems_.push_back(correction(t, (1 + 2 * r) / ((1 + r) * dt), predictor, rate));
    }
    if (Status status = evaluate_residuals(); !status.ok()) return status;
    solver_.solve(systems_, settings_.linear_tolerance_or(kLinearTolerance));
    for (const NewtonSystem& system : systems_)
      if (!system.report.status.ok()) return system.report.status;

    first_ = systems_[0].y + systems_[0].x;
    second_ = systems_.back().y + systems_.back().x;
    // At the start, half the difference to explicit Euler: the leading term of the local error.
    error = started()
                ? problem_.norm(second_ - first_) / problem_.norm(second_)
                : 0.5 * problem_.norm(first_ - y - dt * rate_) / std::max(problem_.norm(y), 1e-300);
    if (first_ == second_ && started()) error = 0;  // c = 0 everywhere is 0/0
    if (std::isnan(error)) return Status::retry("the error estimate is not a number");
    return control_.accepts(error) ? choose_solution() : Status{};
  }

  Status choose_solution() {
    kept_second_ = keeps_second();
    return guard_.judge(kept_second_ ? second_ : first_);
  }

  void accept(double dt, double t, double error) {
    guard_.accept();
    statistics_.first_order += !kept_second_;
    statistics_.order = kept_second_ && started() ? 2 : 1;
    history_.add(t, kept_second_ ? second_ : first_);
    step_ = dt;
    next_ = control_.after_acceptance(dt, error);
    ++statistics_.steps;
  }

  const DaeProblem& problem_;
  IntegratorSettings settings_;
  StepControl control_;
  IntegratorStatistics statistics_;
  EnergyGuard guard_;
  double energy_ = 0;  // of y_n, where it decides which solution is kept
  double t_end_ = 0, span_ = 0, step_ = 0, next_ = 0;
  History history_{3};  // interpolates to order 2
  Vec rate_;            // ẏ at the start
  JacobianSolver solver_;
  std::vector<NewtonSystem> systems_;  // of an attempt: first and second order
  Vec first_, second_;                 // and what they give,
  bool kept_second_ = true;            // of which one goes on
};

}  // namespace

IntegratorPtr make_euler(const DaeProblem& problem, const LinearSolverChoice& solvers,
                         std::shared_ptr<const ThreadTeam> team,
                         const IntegratorSettings& settings) {
  return std::make_unique<Euler>(problem, solvers, std::move(team), settings);
}

}  // namespace traceraft
