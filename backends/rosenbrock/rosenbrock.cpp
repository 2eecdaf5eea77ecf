#include "backends/rosenbrock/rosenbrock.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kernel/core/stopwatch.hpp"
#include "kernel/time/controlled_integrator.hpp"

namespace traceraft::rosenbrock {
namespace {

constexpr int kStages = 4;

// A stage is about tolerance^(1/3) of the state and must be solved to a tenth of the tolerance.
double linear_tolerance(const time::IntegratorSettings& settings) {
  return settings.linear_tolerance_or(std::min(1e-3, 0.1 * std::pow(settings.tolerance, 2.0 / 3)));
}

// The method in the variables u = Γ k, which need no product with the Jacobian.
struct Tableau {
  double gamma;
  Eigen::Matrix4d a, c;                        // strictly lower triangular
  Eigen::Vector4d weights, error, at, gammas;  // gammas: row sums of Γ, at: of α
};

// Coefficients of ROS34PW2 (Rang and Angermann 2005, table 4.2).
const Tableau& ros34pw2() {
  static const Tableau tableau = [] {
    constexpr double g = 4.3586652150845900e-01;
    Eigen::Matrix4d alpha, Gamma;
    alpha << 0, 0, 0, 0,                                        //
        8.7173304301691801e-01, 0, 0, 0,                        //
        8.4457060015369423e-01, -1.1299064236484185e-01, 0, 0,  //
        0, 0, 1, 0;
    Gamma << g, 0, 0, 0,                                        //
        -8.7173304301691801e-01, g, 0, 0,                       //
        -9.0338057013044082e-01, 5.4180672388095326e-02, g, 0,  //
        2.4212380706095346e-01, -1.2232505839045147e+00, 5.4526025533510214e-01, g;
    const Eigen::RowVector4d b(2.4212380706095346e-01, -1.2232505839045147e+00,
                               1.5452602553351020e+00, g);
    const Eigen::RowVector4d b_hat(3.7810903145819369e-01, -9.6042292212423178e-02, 0.5,
                                   2.1793326075422950e-01);
    const Eigen::Matrix4d inverse = Gamma.inverse();
    Tableau t;
    t.gamma = g;
    t.a = alpha * inverse;
    t.c = Eigen::Matrix4d(inverse.diagonal().asDiagonal()) - inverse;
    t.weights = (b * inverse).transpose();
    t.error = ((b - b_hat) * inverse).transpose();
    t.at = alpha.rowwise().sum();
    t.gammas = Gamma.rowwise().sum();
    return t;
  }();
  return tableau;
}

class Rosenbrock final : public time::ControlledIntegrator {
 public:
  Rosenbrock(const problem::DaeProblem& problem, const linear::LinearSolverChoice& solvers,
             std::shared_ptr<const ThreadTeam> team, const time::IntegratorSettings& settings)
      : time::ControlledIntegrator(problem, solvers, 1, std::move(team), settings, 3, 1) {}

  std::string name() const override { return "rosenbrock"; }
  bool promises_energy_decay() const override { return false; }

  // A step begins at a consistent state: where both halves were carried to another mesh, μ follows
  // from c there.
  void load(CheckpointIn in) override {
    time::ControlledIntegrator::load(in);
    if (!in.carried) return;
    Vec rate(problem_.size());
    const Status status = problem_.consistent_initial_state(time(), history_.newest(), rate);
    if (!status.ok()) throw IoError("its state has no potential there: " + status.why);
  }

 private:
  Status residual(double t, VecView y, VecView ydot, Vec& r) {
    const ScopedTimer timer(statistics_.assembly_seconds);
    ++statistics_.residuals;
    r.resize(problem_.size());
    return problem_.residual(t, y, ydot, r);
  }

  // F at stage i. At the first one it is `at_start`, which is known.
  Status stage_residual(int i, double dt, const Vec& at_start, Vec& r) {
    if (i == 0) {
      r = at_start;
      return {};
    }
    const Tableau& tableau = ros34pw2();
    Vec y = state(), rate = Vec::Zero(y.size());
    for (int j = 0; j < i; ++j) {
      y += tableau.a(i, j) * stage_[j];
      rate -= tableau.c(i, j) / dt * stage_[j];
    }
    return residual(time() + tableau.at[i] * dt, y, rate, r);
  }

  // Solves stage i for u_i; `drift` is ∂F/∂t.
  Status solve_stage(int i, double dt, const Vec& at_start, const Vec& drift) {
    time::NewtonSystem& system = systems_[0];
    const Status status = stage_residual(i, dt, at_start, system.b);
    if (!status.ok()) return status;
    system.b = -system.b - ros34pw2().gammas[i] * dt * drift;
    system.x = Vec::Zero(system.b.size());
    const double tolerance = linear_tolerance(settings_);
    if (i == 0) {
      solver_.solve(systems_, tolerance);
    } else {
      solver_.solve_again(systems_, tolerance);
    }
    stage_[i] = system.x;
    return system.report.status;
  }

  Status attempt(double dt, double& error) override {
    time::NewtonSystem& system = systems_[0];
    system.t = time();
    system.shift = 1 / (ros34pw2().gamma * dt);
    system.tangent = linear::Tangent::exact;
    system.y = state();
    system.ydot = Vec::Zero(state().size());
    Vec at_start, later;
    // ∂F/∂t by a difference; exactly zero for an autonomous model.
    const double delta = 1e-6 * dt;
    Status status = residual(time(), system.y, system.ydot, at_start);
    if (status.ok()) status = residual(time() + delta, system.y, system.ydot, later);
    if (!status.ok()) return status;
    const Vec drift = (later - at_start) / delta;
    for (int i = 0; i < kStages; ++i)
      if (status = solve_stage(i, dt, at_start, drift); !status.ok()) return status;
    result_ = state();
    Vec defect = Vec::Zero(result_.size());
    for (int i = 0; i < kStages; ++i) {
      result_ += ros34pw2().weights[i] * stage_[i];
      defect += ros34pw2().error[i] * stage_[i];
    }
    error = problem_.norm(defect) / std::max(problem_.norm(result_), 1e-300);
    return {};
  }

  Vec result() override { return std::move(result_); }
  void accepted() override { statistics_.order = 3; }

  std::vector<time::NewtonSystem> systems_ = std::vector<time::NewtonSystem>(1);
  std::array<Vec, kStages> stage_;
  Vec result_;
};

}  // namespace

time::IntegratorPtr make_rosenbrock(const problem::DaeProblem& problem,
                                    const linear::LinearSolverChoice& solvers,
                                    std::shared_ptr<const ThreadTeam> team,
                                    const time::IntegratorSettings& settings) {
  return std::make_unique<Rosenbrock>(problem, solvers, std::move(team), settings);
}

}  // namespace traceraft::rosenbrock
