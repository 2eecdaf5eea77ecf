#include "backends/sundials/ida.hpp"

#include <ida/ida.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

#include "backends/sundials/ida_equations.hpp"
#include "backends/sundials/ida_memory.hpp"
#include "backends/sundials/state_vector.hpp"
#include "kernel/time/step_control.hpp"

namespace traceraft::sundials {
namespace {

class Ida final : public time::Integrator {
 public:
  Ida(const problem::DaeProblem& problem, const linear::LinearSolverChoice& solvers,
      std::shared_ptr<const ThreadTeam> team, const time::IntegratorSettings& settings)
      : problem_(problem),
        settings_(settings),
        equations_(problem, solvers, std::move(team), settings_),
        space_{[this](VecView half) { return problem_.field_norm(half); }, problem.ranks()} {
    if (SUNContext_Create(nullptr, &context_) != 0)
      throw std::runtime_error("SUNDIALS: no context");
  }
  ~Ida() override {
    release();
    SUNContext_Free(&context_);
  }
  Ida(const Ida&) = delete;
  Ida& operator=(const Ida&) = delete;

  std::string name() const override { return "ida"; }

  Status start(double t0, VecView y0, VecView ydot0, double t_end) override {
    t_end_ = t_end;
    span_ = t_end - t0;
    first_step_ = choose_first_step(y0, ydot0);
    create(t0, y0, ydot0);
    y_ = y0;
    before_ = t_ = t0;
    equations_.start(y0);
    return {};
  }

  Status advance() override {
    if (!(t_ < t_end_)) return Status::fatal("the end of the run has been reached");
    equations_.forget_complaints();
    double t = t_;
    const int flag = IDASolve(memory_, t_end_, &t, yy_.get(), yp_.get(), IDA_ONE_STEP);
    equations_.throw_again();
    if (flag != IDA_SUCCESS && flag != IDA_TSTOP_RETURN) return failure(flag);
    before_ = t_;
    t_ = t;
    y_ = view(yy_.get());
    equations_.accept();
    return {};
  }

  Status interpolate(double t, VecRef y) const override {
    if (!(t >= before_ && t <= t_)) return Status::fatal("interpolation outside the last step");
    if (t == t_) {
      y = y_;
      return {};
    }
    if (IDAGetDky(memory_, t, 0, between_.get()) != IDA_SUCCESS)
      return Status::fatal("IDAGetDky: " + equations_.message());
    y = view(between_.get());
    return {};
  }

  double time() const override { return t_; }
  double step() const override {
    double h = 0;
    if (memory_) IDAGetLastStep(memory_, &h);
    return h;
  }
  double next_step() const override {
    double h = 0;
    if (memory_) IDAGetCurrentStep(memory_, &h);
    return h;
  }
  const Vec& state() const override { return y_; }
  bool promises_energy_decay() const override { return false; }

  time::IntegratorStatistics statistics() const override {
    time::IntegratorStatistics result;
    if (!memory_) return equations_.added_to(result);
    IDAGetNumSteps(memory_, &result.steps);
    IDAGetNumErrTestFails(memory_, &result.rejected);
    IDAGetNumNonlinSolvIters(memory_, &result.newton_iterations);
    IDAGetNumStepSolveFails(memory_, &result.failures);
    IDAGetLastOrder(memory_, &result.order);
    return equations_.added_to(result);
  }
  linear::LinearStatistics linear_statistics() const override {
    return equations_.linear_statistics();
  }

  void save(CheckpointOut out) const override {
    for (const double value : {before_, t_, t_end_, span_, first_step_}) write_binary(out, value);
    equations_.save_residuals(out);
    write_binary(out, y_);
    save_ida_memory(memory_, out);
    equations_.save(out);
  }
  void load(CheckpointIn in) override {
    for (double* value : {&before_, &t_, &t_end_, &span_, &first_step_}) read_binary(in, *value);
    equations_.load_residuals(in);
    read_binary(in, y_, problem_.size());
    create(t_, y_, Vec::Zero(y_.size()));
    load_ida_memory(memory_, in);
    equations_.load(in, y_);
  }

 private:
  double choose_first_step(VecView y, VecView ydot) const {
    if (settings_.option("initstep") > 0) return settings_.option("initstep");
    const int n = problem_.block_size();
    // A tenth of the tolerance is the whole change of the first step.
    return time::first_step(settings_.general(), span_,
                            0.1 * settings_.rtol() * problem_.field_norm(y.head(n)),
                            problem_.field_norm(ydot.head(n)));
  }

  void release() {
    if (memory_) IDAFree(&memory_);
    equations_.detach();
    for (VectorPtr* v : {&yy_, &yp_, &id_, &between_}) v->reset();
  }

  void create(double t0, VecView y0, VecView ydot0) {
    release();
    const Eigen::Index size = problem_.size();
    for (VectorPtr* v : {&yy_, &yp_, &id_, &between_})
      v->reset(new_state_vector(size, space_, context_));
    view(yy_.get()) = y0;
    view(yp_.get()) = ydot0;
    view(id_.get()).head(size / 2).setOnes();
    memory_ = IDACreate(context_);
    if (!memory_) throw std::bad_alloc();
    equations_.attach(memory_, t0, yy_.get(), yp_.get(), context_);
    set_options();
  }

  void set_options() {
    const auto must = [&](int flag) {
      if (flag != IDA_SUCCESS) throw std::runtime_error("IDA: " + equations_.message());
    };
    must(IDASetId(memory_, id_.get()));
    must(IDASetSuppressAlg(memory_, settings_.option("suppressalg") != 0));
    must(IDASetMaxOrd(memory_, static_cast<int>(settings_.option("maxord"))));
    must(IDASetNonlinConvCoef(memory_, settings_.option("nonlinconvcoef")));
    must(IDASetMaxNumSteps(memory_, -1));  // unlimited
    must(IDASetMaxErrTestFails(memory_, 100));
    must(IDASetMaxConvFails(memory_, 100));  // the smallest step ends a run, not their number
    must(IDASetInitStep(memory_, first_step_));
    const double longest = std::min(settings_.max_step(), problem_.longest_step());
    must(IDASetMinStep(memory_, std::min(settings_.min_step(span_), longest)));
    must(IDASetMaxStep(memory_, longest));
    must(IDASetStopTime(memory_, t_end_));
  }

  Status failure(int flag) const {
    const std::string reason = equations_.complaint();
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
            "no step size down to the smallest one" +
            (reason.empty() ? "; Newton's method does not converge" : ": " + reason));
      case IDA_RES_FAIL:
        return Status::fatal("the equations cannot be evaluated" +
                             (reason.empty() ? "" : ": " + reason));
      case IDA_TOO_MUCH_ACC:
        return Status::fatal("the tolerance is smaller than roundoff allows; take a larger one");
      case IDA_ILL_INPUT:
        return Status::fatal(
            "the first step cannot be chosen: the end of the run, the initial and the largest step "
            "do not go together");
      default:
        return Status::fatal("IDA code " + std::to_string(flag) +
                             (reason.empty() ? "" : ": " + reason));
    }
  }

  const problem::DaeProblem& problem_;
  const IdaSettings settings_;
  IdaEquations equations_;
  StateSpace space_;
  SUNContext context_ = nullptr;
  void* memory_ = nullptr;
  VectorPtr yy_, yp_, id_, between_;
  double before_ = 0, t_ = 0;  // ends of the last step
  double t_end_ = 0, span_ = 0, first_step_ = 0;
  Vec y_;
};

}  // namespace

time::IntegratorPtr make_ida(const problem::DaeProblem& problem,
                             const linear::LinearSolverChoice& solvers,
                             std::shared_ptr<const ThreadTeam> team,
                             const time::IntegratorSettings& settings) {
  return std::make_unique<Ida>(problem, solvers, std::move(team), settings);
}

}  // namespace traceraft::sundials
