#include "backends/sundials/ida.hpp"

#include <ida/ida.h>
#include <sundials/sundials_linearsolver.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include "backends/sundials/ida_memory.hpp"
#include "backends/sundials/newton_test.hpp"
#include "backends/sundials/state_vector.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/time/energy_guard.hpp"
#include "kernel/time/jacobian_solver.hpp"
#include "kernel/time/step_control.hpp"

namespace traceraft {
namespace {

struct Destroy {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFreeEmpty(solver); }
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
using VectorPtr = std::unique_ptr<_generic_N_Vector, Destroy>;
using LinearPtr = std::unique_ptr<_generic_SUNLinearSolver, Destroy>;
using NewtonPtr = std::unique_ptr<_generic_SUNNonlinearSolver, Destroy>;

constexpr double kLinearTolerance = 1e-2;
// Later corrections of a step are smaller and need not be as accurate.
constexpr double kLaterFactor = 10;

class Ida final : public Integrator {
 public:
  Ida(const DaeProblem& problem, const LinearSolverChoice& solvers,
      std::shared_ptr<const ThreadTeam> team, const IntegratorSettings& settings)
      : problem_(problem),
        settings_(settings),
        guard_(problem, settings),
        solver_(problem, solvers, 1, std::move(team)),
        space_{[this](ConstVec half) { return problem_.field_norm(half); }, problem.ranks()} {
    if (SUNContext_Create(nullptr, &context_) != 0)
      throw std::runtime_error("SUNDIALS: no context");
    systems_.resize(1);
    for (const ParameterSpec& spec : ida_parameters())
      settings_.own.emplace(spec.name, spec.default_value);
  }
  ~Ida() override {
    release();
    SUNContext_Free(&context_);
  }
  Ida(const Ida&) = delete;
  Ida& operator=(const Ida&) = delete;

  std::string name() const override { return "ida"; }

  Status start(double t0, ConstVec y0, ConstVec ydot0, double t_end) override {
    t_end_ = t_end;
    span_ = t_end - t0;
    first_step_ = choose_first_step(y0, ydot0);
    create(t0, y0, ydot0);
    y_ = y0;
    before_ = t_ = t0;
    guard_.start(y0);
    return {};
  }

  Status advance() override {
    if (!(t_ < t_end_)) return Status::fatal("the end of the run has been reached");
    message_.clear();
    why_.clear();
    double t = t_;
    const int flag = IDASolve(memory_, t_end_, &t, yy_.get(), yp_.get(), IDA_ONE_STEP);
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    if (flag != IDA_SUCCESS && flag != IDA_TSTOP_RETURN) return failure(flag);
    before_ = t_;
    t_ = t;
    y_ = view(yy_.get());
    guard_.accept();
    return {};
  }

  Status interpolate(double t, VecRef y) const override {
    if (!(t >= before_ && t <= t_)) return Status::fatal("interpolation outside the last step");
    if (t == t_) {
      y = y_;
      return {};
    }
    if (IDAGetDky(memory_, t, 0, work_.get()) != IDA_SUCCESS)
      return Status::fatal("IDAGetDky: " + message_);
    y = view(work_.get());
    return {};
  }

  double time() const override { return t_; }
  double step() const override {
    double h = 0;
    IDAGetLastStep(memory_, &h);
    return h;
  }
  double next_step() const override {
    double h = 0;
    IDAGetCurrentStep(memory_, &h);
    return h;
  }
  const Vec& state() const override { return y_; }
  bool promises_energy_decay() const override { return false; }

  IntegratorStatistics statistics() const override {
    IntegratorStatistics result;
    IDAGetNumSteps(memory_, &result.steps);
    IDAGetNumErrTestFails(memory_, &result.rejected);
    IDAGetNumNonlinSolvIters(memory_, &result.newton_iterations);
    IDAGetNumStepSolveFails(memory_, &result.failures);
    IDAGetLastOrder(memory_, &result.order);
    result.energy_rises = guard_.refused();
    result.residuals = residuals_;
    result.assembly_seconds = residual_seconds_;
    return solver_.added_to(result);
  }
  LinearStatistics linear_statistics() const override { return solver_.linear_statistics(); }

  void save(CheckpointOut out) const override {
    for (const double value : {before_, t_, t_end_, span_, first_step_, residual_seconds_})
      write_binary(out, value);
    write_binary(out, residuals_);
    write_binary(out, y_);
    save_ida_memory(memory_, out);
    newton_test_.save(out);
    guard_.save(out);
    solver_.save(out);
  }
  void load(CheckpointIn in) override {
    for (double* value : {&before_, &t_, &t_end_, &span_, &first_step_, &residual_seconds_})
      read_binary(in, *value);
    read_binary(in, residuals_);
    read_binary(in, y_, problem_.size());
    create(t_, y_, Vec::Zero(y_.size()));
    load_ida_memory(memory_, in);
    newton_test_.load(in);
    guard_.load(in);
    solver_.load(in);
  }

 private:
  double option(const char* name) const { return settings_.own.at(name); }
  double either(const char* name, double general) const {
    return option(name) > 0 ? option(name) : general;
  }
  double choose_first_step(ConstVec y, ConstVec ydot) const {
    if (option("initstep") > 0) return option("initstep");
    const int n = problem_.block_size();
    // A tenth of the tolerance is the whole change of the first step.
    return first_step(settings_, span_, 0.1 * rtol() * problem_.field_norm(y.head(n)),
                      problem_.field_norm(ydot.head(n)));
  }
  double linear_tolerance() const {
    return either("epslin", settings_.linear_tolerance_or(kLinearTolerance));
  }
  double rtol() const { return either("rtol", settings_.tolerance); }

  void release() {
    if (memory_) IDAFree(&memory_);
    newton_.reset();
    linear_.reset();
    for (VectorPtr* v : {&yy_, &yp_, &id_, &work_}) v->reset();
  }

  void create(double t0, ConstVec y0, ConstVec ydot0) {
    release();
    const Eigen::Index size = problem_.size();
    for (VectorPtr* v : {&yy_, &yp_, &id_, &work_})
      v->reset(new_state_vector(size, space_, context_));
    view(yy_.get()) = y0;
    view(yp_.get()) = ydot0;
    view(id_.get()).head(size / 2).setOnes();
    unit_ = problem_.field_norm(Vec::Ones(size / 2));
    memory_ = IDACreate(context_);
    if (!memory_) throw std::bad_alloc();
    const auto must = [&](int flag) {
      if (flag != IDA_SUCCESS) throw std::runtime_error("IDA: " + message_);
    };
    must(IDASetErrHandlerFn(memory_, on_error, this));
    must(IDAInit(memory_, residual, t0, yy_.get(), yp_.get()));
    must(IDASetUserData(memory_, this));
    must(IDAWFtolerances(memory_, error_weights));
    must(IDASetId(memory_, id_.get()));
    must(IDASetSuppressAlg(memory_, option("suppressalg") != 0));
    must(IDASetMaxOrd(memory_, static_cast<int>(option("maxord"))));
    must(IDASetMaxNumSteps(memory_, -1));  // unlimited
    must(IDASetMaxErrTestFails(memory_, 100));
    must(IDASetMaxConvFails(memory_, 100));  // the smallest step ends a run, not their number
    must(IDASetInitStep(memory_, first_step_));
    must(IDASetMinStep(memory_, settings_.min_step > 0 ? settings_.min_step : 1e-14 * span_));
    const double asked = either("maxstep", settings_.max_step);
    const double most = asked > 0 ? asked : std::numeric_limits<double>::infinity();
    must(IDASetMaxStep(memory_, std::min(most, problem_.longest_step())));
    must(IDASetStopTime(memory_, t_end_));
    make_linear_solver();
    must(IDASetLinearSolver(memory_, linear_.get(), nullptr));
    newton_.reset(SUNNonlinSol_Newton(yy_.get(), context_));
    if (!newton_) throw std::bad_alloc();
    must(IDASetNonlinearSolver(memory_, newton_.get()));
    SUNNonlinSolSetConvTestFn(newton_.get(), converged, this);
    must(IDASetNonlinConvCoef(memory_, option("nonlinconvcoef")));
  }

  // IDA asks nothing of a "matrix-embedded" solver but to solve with the current iterate.
  void make_linear_solver() {
    linear_.reset(SUNLinSolNewEmpty(context_));
    if (!linear_) throw std::bad_alloc();
    linear_->content = this;
    linear_->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_MATRIX_EMBEDDED; };
    linear_->ops->getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
    linear_->ops->initialize = [](SUNLinearSolver) -> int { return SUNLS_SUCCESS; };
    linear_->ops->solve = solve;
    linear_->ops->numiters = [](SUNLinearSolver s) {
      return std::max(1, static_cast<Ida*>(s->content)->systems_[0].report.iterations);
    };
    linear_->ops->resid = [](SUNLinearSolver s) {
      return static_cast<Ida*>(s->content)->work_.get();
    };
    linear_->ops->resnorm = [](SUNLinearSolver) { return 0.0; };
  }

  static int converged(SUNNonlinearSolver newton, N_Vector total, N_Vector correction, double bound,
                       N_Vector weights, void* data) {
    auto& self = *static_cast<Ida*>(data);
    int iteration = 0;
    SUNNonlinSolGetCurIter(newton, &iteration);
    switch (self.newton_test_.judge(iteration, N_VWrmsNorm(correction, weights), bound)) {
      case NewtonTest::Verdict::converged:
        return self.permits(total) ? SUN_NLS_SUCCESS : SUN_NLS_CONV_RECVR;
      case NewtonTest::Verdict::go_on:
        return SUN_NLS_CONTINUE;
      default:
        return SUN_NLS_CONV_RECVR;
    }
  }

  // May the predictor with this total correction become the next state? If not, IDA retries with a
  // smaller step, as if Newton's method had failed.
  bool permits(N_Vector total) {
    if (!guard_.active()) return true;
    const int refused = guarded(1, [&] {
      IDAComputeY(memory_, total, work_.get());
      return code(guard_.judge(view(work_.get())), 1, 1);
    });
    return refused == 0;
  }

  // What IDA is told of a status. A listed code: 6.4 takes any other for success.
  int code(const Status& status, int retry, int fatal) {
    why_ = status.why;
    if (status.ok()) return 0;
    return status.outcome == Outcome::retry ? retry : fatal;
  }

  // Runs `action` behind the C boundary: an exception is kept and thrown again in advance().
  template <class Action>
  int guarded(int fatal, const Action& action) noexcept {
    try {
      return action();
    } catch (...) {
      thrown_ = std::current_exception();
      return fatal;
    }
  }

  static int residual(double t, N_Vector y, N_Vector ydot, N_Vector r, void* data) {
    auto& self = *static_cast<Ida*>(data);
    return self.guarded(-1, [&] {
      const ScopedTimer timer(self.residual_seconds_);
      ++self.residuals_;
      return self.code(self.problem_.residual(t, view(y), view(ydot), view(r)), 1, -1);
    });
  }

  static int error_weights(N_Vector y, N_Vector weights, void* data) {
    auto& self = *static_cast<Ida*>(data);
    return self.guarded(-1, [&] {
      const Eigen::Index n = self.problem_.block_size();
      const double floor = self.either("atol", 1e-10) * self.unit_;
      const auto set = [&](Eigen::Index half) {
        view(weights).segment(half, n).setConstant(
            1 / (self.rtol() * self.problem_.field_norm(view(y).segment(half, n)) + floor));
      };
      set(0);
      // Newton's method is judged by what the error test is about.
      if (self.option("suppressalg") != 0) {
        view(weights).tail(n).setZero();
      } else {
        set(n);
      }
      return 0;
    });
  }

  static int solve(SUNLinearSolver linear, SUNMatrix, N_Vector x, N_Vector b, double) {
    auto& self = *static_cast<Ida*>(linear->content);
    return self.guarded(SUNLS_PACKAGE_FAIL_UNREC, [&] {
      N_Vector y = nullptr, ydot = nullptr;
      NewtonSystem& system = self.systems_[0];
      IDAGetCurrentTime(self.memory_, &system.t);
      IDAGetCurrentY(self.memory_, &y);
      IDAGetCurrentYp(self.memory_, &ydot);
      IDAGetCurrentCj(self.memory_, &system.shift);
      system.tangent = Tangent::exact;
      system.y = view(y);
      system.ydot = view(ydot);
      system.b = view(b);
      system.x = Vec::Zero(system.b.size());
      int iteration = 0;
      SUNNonlinSolGetCurIter(self.newton_.get(), &iteration);
      const double tolerance = self.linear_tolerance();
      self.solver_.solve(self.systems_,
                         iteration == 0 ? tolerance : std::min(0.5, kLaterFactor * tolerance));
      const Status& status = system.report.status;
      view(x) = system.x;
      return self.code(status, SUNLS_PACKAGE_FAIL_REC, SUNLS_PACKAGE_FAIL_UNREC);
    });
  }

  static void on_error(int code, const char*, const char*, char* text, void* data) {
    if (code < 0) static_cast<Ida*>(data)->message_ = text;
  }

  Status failure(int flag) const {
    const std::string reason = why_.empty() ? message_ : why_;
    switch (flag) {
      case IDA_ERR_FAIL:
        return Status::fatal(
            "no step size: the error stays above the tolerance down to the smallest step");
      case IDA_LSOLVE_FAIL:
        return Status::fatal("the linear solver failed: " + reason);
      case IDA_CONV_FAIL:
      case IDA_REP_RES_ERR:
      case IDA_FIRST_RES_FAIL:
        return Status::fatal(
            "no step size: " + (reason.empty() ? "Newton's method does not converge" : reason) +
            " down to the smallest step");
      default:
        return Status::fatal("IDA code " + std::to_string(flag) + ": " + reason +
                             " (its times are in R^2/D)");
    }
  }

  const DaeProblem& problem_;
  IntegratorSettings settings_;
  EnergyGuard guard_;
  JacobianSolver solver_;
  StateSpace space_;
  SUNContext context_ = nullptr;
  void* memory_ = nullptr;
  VectorPtr yy_, yp_, id_, work_;
  LinearPtr linear_;
  NewtonPtr newton_;
  std::vector<NewtonSystem> systems_;
  double before_ = 0, t_ = 0;  // ends of the last step
  double t_end_ = 0, span_ = 0, first_step_ = 0, unit_ = 1;
  Vec y_;
  NewtonTest newton_test_;
  long residuals_ = 0;
  double residual_seconds_ = 0;
  std::string message_, why_;  // IDA's last complaint, and what made a callback fail
  std::exception_ptr thrown_;
};

}  // namespace

IntegratorPtr make_ida(const DaeProblem& problem, const LinearSolverChoice& solvers,
                       std::shared_ptr<const ThreadTeam> team, const IntegratorSettings& settings) {
  return std::make_unique<Ida>(problem, solvers, std::move(team), settings);
}

std::vector<ParameterSpec> ida_parameters() {
  return {
      {"rtol", "", 0, 0, 0.5, "relative tolerance in L2 of the surface; 0: --tolerance"},
      {"atol", "", 0, 0, 1e3, "absolute tolerance of c; 0: 1e-10"},
      {"maxord", "", 5, 1, 5, "maximum order of the BDF", true},
      {"initstep", "s", 0, 0, 1e300, "first step; 0: --initial-step"},
      {"maxstep", "s", 0, 0, 1e300, "largest step; 0: --max-step"},
      {"suppressalg", "", 1, 0, 1, "1: algebraic variables are left out of the error test", true},
      {"epslin", "", 0, 0, 0.5, "relative residual of Newton corrections; 0: --linear-tolerance"},
      {"nonlinconvcoef", "", 0.33, 1e-6, 1, "factor in the test of Newton's convergence"},
  };
}

}  // namespace traceraft
