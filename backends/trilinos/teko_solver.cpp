#include "backends/trilinos/teko_solver.hpp"

#include <Teko_PreconditionerInverseFactory.hpp>
#include <Teko_RequestHandler.hpp>
#include <Thyra_DefaultProductVector.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_VectorStdOps.hpp>
#include <array>
#include <exception>
#include <mutex>
#include <stdexcept>

#include "backends/trilinos/belos_method.hpp"
#include "backends/trilinos/inverse_library.hpp"
#include "backends/trilinos/runtime.hpp"
#include "backends/trilinos/teko_parameters.hpp"
#include "backends/trilinos/two_solve_factory.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/linear/setup_policy.hpp"
#include "kernel/linear/two_solve_preconditioner.hpp"

namespace traceraft::trilinos {
namespace {

using Teuchos::RCP;
using Teuchos::rcp;

// Measured at n = 128: a new hierarchy costs about as much as 5 iterations.
constexpr long kSetupPrice = 5;

// Everything that does not change from solver to solver.
struct Setting {
  fem::PatternPtr pattern;
  TpetraSpace space;
  TekoParameters chosen;
  RCP<Teko::InverseLibrary> library;
};

// B + sM must be positive definite with the exact tangent. No approximate inverse notices if it is
// not. The constant function tells where f0'' is negative on the whole.
linear::TwoSolveShifts shifts_of(const linear::BlockJacobian& J, double area) {
  double sum = 0;
  for (const double value : J.mc.values) sum -= value;
  const double mean = J.ranks().sum(sum) / area;  // of f0''; the stiffness has no part in it
  linear::TwoSolveShifts shifts = linear::two_solve_shifts(J);
  for (int attempt = 1; attempt < linear::kMostShifts && mean - shifts.q <= 0; ++attempt)
    shifts = linear::two_solve_shifts(J, attempt);
  return shifts;
}

class TekoSolver final : public linear::LinearSolver {
 public:
  TekoSolver(std::shared_ptr<const Setting> setting, int lanes)
      : setting_(std::move(setting)), shared_(lanes, kSetupPrice), lanes_(lanes) {
    const TpetraSpace& space = setting_->space;
    for (RCP<TpetraMatrix>& block : blocks_) block = space.make_matrix();
    A_ = Thyra::block2x2<double>(as_operator(blocks_[0]), as_operator(blocks_[1]),
                                 as_operator(blocks_[2]), as_operator(blocks_[3]));
    handler_ = rcp(new Teko::RequestHandler);
    handler_->addRequestCallback(rcp(new TwoSolveCallback(request_)));
    setting_->library->setRequestHandler(handler_);
    factory_ = setting_->library->getInverseFactory(setting_->chosen.preconditioner);
    for (Lane& lane : lanes_) {
      lane.method = make_belos_method(setting_->chosen.method, setting_->chosen.belos);
      lane.b = Thyra::createMember(A_->range());
      lane.x = Thyra::createMember(A_->domain());
    }
  }

  std::string name() const override { return "teko"; }
  bool shares_factors() const override { return true; }

  Status setup(const linear::BlockJacobian& J, int) override {
    const ScopedTimer timer(shared_.seconds());
    shared_.begin(J.shift);
    fill(J);
    double area = 0;
    for (const double value : J.mm.values) area += value;
    const linear::TwoSolveShifts shifts = shifts_of(J, J.ranks().sum(area));
    request_ = {shifts.p, shifts.q, row_scale_};
    const Status status = guarded("no preconditioner", [&]() -> Status {
      if (inverse_.is_null())
        inverse_ = Teko::buildInverse(*factory_, A_);
      else
        Teko::rebuildInverse(*factory_, A_, inverse_);
      return {};
    });
    if (status.ok())
      shared_.succeed();
    else
      inverse_ = Teuchos::null;
    return status;
  }

  bool wants_setup(const linear::BlockJacobian& J, int) const override {
    return setting_->chosen.always_new || shared_.worn(J.shift);
  }

  linear::SolveReport solve(const linear::BlockJacobian& J, VecView b, VecRef x, double tolerance,
                            int lane_number) override {
    // Trilinos keeps what it computes with in its objects.
    const std::lock_guard lock(one_at_a_time_);
    Lane& lane = lanes_[lane_number];
    linear::LinearStatistics& statistics = shared_.of_lane(lane_number);
    const ScopedTimer timer(statistics.solve_seconds);
    ++statistics.solves;
    if (!shared_.ready()) return {Status::retry("there is no preconditioner")};
    fill(J);
    const int n = J.block_size();
    copy_halves(b, 1 / row_scale_, *lane.b);
    copy_halves(x, 1, *lane.x);
    linear::SolveReport report;
    report.status = guarded("Belos", [&] {
      report = lane.method->solve(A_, inverse_, lane.b, lane.x, tolerance);
      return report.status;
    });
    shared_.count(lane_number, report.iterations);
    if (!report.status.ok()) lane.method->forget();
    copy_from(*block(*lane.x, 0), x.head(n));
    copy_from(*block(*lane.x, 1), x.tail(n));
    report.status = linear::judged_by_residual(report.status, J, b, x, tolerance, team_);
    if (report.status.ok()) linear::restore_mass(J, b, x);
    return report;
  }

  linear::LinearStatistics statistics() const override { return shared_.statistics(); }
  void save(CheckpointOut out) const override {
    write_binary(out, setting_->chosen.checksum);
    shared_.save(out);
    // Recycled vectors are not saved: the run goes on like one that is resumed here.
    for (const Lane& lane : lanes_) lane.method->forget();
  }
  void load(CheckpointIn in) override {
    std::size_t checksum = 0;
    read_binary(in, checksum);
    if (checksum != setting_->chosen.checksum)
      throw IoError("the file of Teuchos parameters is not the one that the run was started with");
    shared_.load(in);
  }

 private:
  // Trilinos turns what goes wrong into exceptions of many kinds. With several ranks the others may
  // wait for this one within a library: only the end of all of them is safe.
  template <class Action>
  Status guarded(const char* what, const Action& action) const {
    try {
      return action();
    } catch (const std::exception& error) {
      const std::string complaint = teko_complaints(), reason = error.what();
      const std::string why = std::string(what) + ": " +
                              (complaint.empty() ? reason.substr(0, reason.find('\n')) : complaint);
      if (setting_->pattern->halo.ranks->size() > 1) throw std::runtime_error("teko: " + why);
      return Status::retry(why);
    }
  }

  struct Lane {
    std::unique_ptr<BelosMethod> method;
    ThyraVector b, x;
  };

  static RCP<Thyra::VectorBase<double>> block(Thyra::VectorBase<double>& vector, int which) {
    return dynamic_cast<Thyra::ProductVectorBase<double>&>(vector).getNonconstVectorBlock(which);
  }
  static void copy_halves(VecView field, double first_scale, Thyra::VectorBase<double>& vector) {
    const Eigen::Index n = field.size() / 2;
    copy_to(first_scale * field.head(n), *block(vector, 0));
    copy_to(field.tail(n), *block(vector, 1));
  }

  // Belos judges by one norm: the first block row is divided by the shift.
  void fill(const linear::BlockJacobian& J) {
    row_scale_ = J.shift > 0 ? J.shift : 1;
    const TpetraSpace& space = setting_->space;
    space.fill(1 / row_scale_, J.cc, *blocks_[0]);
    space.fill(1 / row_scale_, J.cm, *blocks_[1]);
    space.fill(1, J.mc, *blocks_[2]);
    space.fill(1, J.mm, *blocks_[3]);
  }

  std::shared_ptr<const Setting> setting_;
  linear::SharedSetup shared_;
  std::vector<Lane> lanes_;
  std::array<RCP<TpetraMatrix>, 4> blocks_;
  ThyraOperator A_;
  TwoSolveRequest request_;
  RCP<Teko::RequestHandler> handler_;
  RCP<Teko::InverseFactory> factory_;
  Teko::InverseLinearOp inverse_;
  ThreadTeam team_{1};
  std::mutex one_at_a_time_;
  double row_scale_ = 1;
};

}  // namespace

linear::LinearSolverFactory make_teko_solver(const fem::PatternPtr& pattern,
                                             const TekoOptions& options) {
  start_trilinos();
  const auto setting =
      std::make_shared<Setting>(Setting{pattern,
                                        TpetraSpace(*pattern),
                                        read_teko_parameters(options, pattern->halo.ranks->size()),
                                        {}});
  const TekoParameters& chosen = setting->chosen;
  (void)said_of_lists(chosen, [&] { return make_belos_method(chosen.method, chosen.belos); });
  setting->library =
      said_of_lists(chosen, [&] { return make_inverse_library(chosen.inverse, chosen.inverses); });
  return [setting](int lanes) { return std::make_unique<TekoSolver>(setting, lanes); };
}

}  // namespace traceraft::trilinos
