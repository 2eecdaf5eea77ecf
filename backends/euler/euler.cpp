#include "backends/euler/euler.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "kernel/core/stopwatch.hpp"
#include "kernel/time/controlled_integrator.hpp"

namespace traceraft::euler {
namespace {

constexpr double kLinearTolerance = 1e-4;

class Euler final : public time::ControlledIntegrator {
 public:
  Euler(const problem::DaeProblem& problem, const linear::LinearSolverChoice& solvers,
        std::shared_ptr<const ThreadTeam> team, const time::IntegratorSettings& settings)
      : time::ControlledIntegrator(problem, solvers, 2, std::move(team), settings, 2, 0.1),
        kept_(problem.may_be_extrapolated() ? settings.kept_solution : "first"),
        least_size_(1e-10 * problem.norm(Vec::Ones(problem.size()))) {}

  std::string name() const override { return "euler"; }

  Status start(double t0, VecView y0, VecView ydot0, double t_end) override {
    energy_ = problem_.energy(y0);
    rate_ = ydot0;
    return time::ControlledIntegrator::start(t0, y0, ydot0, t_end);
  }

  bool promises_energy_decay() const override {
    return problem_.dissipates_in_stabilised_steps() && kept_ != "second";
  }

  void save(CheckpointOut out) const override {
    time::ControlledIntegrator::save(out);
    write_binary(out, rate_);
  }
  void load(CheckpointIn in) override {
    time::ControlledIntegrator::load(in);
    read_binary(in, rate_, problem_.size());
    energy_ = problem_.energy(state());
  }

 private:
  bool started() const { return history_.size() > 1; }

  // The second-order solution is the more accurate one; the first-order one never gains energy.
  bool keeps_second() {
    if (kept_ != "decaying" || !problem_.dissipates_energy()) return kept_ != "first";
    const double second_energy = problem_.energy(second_);
    const bool decays = second_energy <= energy_;
    next_energy_ = decays ? second_energy : problem_.energy(first_);
    return decays;
  }

  // The system whose solution added to the predictor y is one of the two solutions of a step.
  static time::NewtonSystem correction(double t, double shift, Vec predictor, Vec rate) {
    time::NewtonSystem system;
    system.t = t;
    system.shift = shift;
    system.tangent = linear::Tangent::stabilised;
    system.y = std::move(predictor);
    system.ydot = std::move(rate);
    system.x = Vec::Zero(system.y.size());
    return system;
  }

  Status evaluate_residuals() {
    const ScopedTimer timer(statistics_.assembly_seconds);
    for (time::NewtonSystem& system : systems_) {
      ++statistics_.residuals;
      system.b.resize(problem_.size());
      const Status status = problem_.residual(system.t, system.y, system.ydot, system.b);
      if (!status.ok()) return status;
      system.b = -system.b;
    }
    return {};
  }

  Status attempt(double dt, double& error) override {
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
    for (const time::NewtonSystem& system : systems_)
      if (!system.report.status.ok()) return system.report.status;

    first_ = systems_[0].y + systems_[0].x;
    second_ = systems_.back().y + systems_.back().x;
    // At the start, half the difference to explicit Euler: the leading term of the local error.
    const double difference =
        started() ? problem_.norm(second_ - first_) : 0.5 * problem_.norm(first_ - y - dt * rate_);
    const double size = problem_.norm(started() ? second_ : y);
    error = difference / std::max(size, least_size_);
    return {};
  }

  Vec result() override {
    kept_second_ = keeps_second();
    return std::move(kept_second_ ? second_ : first_);
  }

  void accepted() override {
    energy_ = next_energy_;
    statistics_.first_order += !kept_second_;
    statistics_.order = kept_second_ && started() ? 2 : 1;
  }

  const std::string kept_;
  const double least_size_;                  // of c: errors are not relative to less
  double energy_ = 0, next_energy_ = 0;      // of y_n and y_{n+1}, where they decide which is kept
  Vec rate_;                                 // ẏ at the start
  std::vector<time::NewtonSystem> systems_;  // of an attempt: first and second order
  Vec first_, second_;                       // and what they give,
  bool kept_second_ = true;                  // of which one goes on
};

}  // namespace

time::IntegratorPtr make_euler(const problem::DaeProblem& problem,
                               const linear::LinearSolverChoice& solvers,
                               std::shared_ptr<const ThreadTeam> team,
                               const time::IntegratorSettings& settings) {
  return std::make_unique<Euler>(problem, solvers, std::move(team), settings);
}

}  // namespace traceraft::euler
