#include "kernel/linear/block_solver.hpp"

#include <vector>

#include "kernel/core/stopwatch.hpp"
#include "kernel/linear/setup_policy.hpp"
#include "kernel/linear/two_solve_preconditioner.hpp"

namespace traceraft::linear {
namespace {

constexpr int kMaxIterations = 200;
// Measured at n = 64, 128 and 176: a set-up costs about as much as 7 to 9 iterations.
constexpr long kSetupPrice = 8;

class BlockSolver final : public LinearSolver {
 public:
  BlockSolver(const SpdSolverFactory& make_spd_solver, const KrylovFactory& make_krylov,
              std::shared_ptr<const ThreadTeam> team, int lanes)
      : preconditioner_(make_spd_solver, lanes),
        team_(std::move(team)),
        shared_(lanes, kSetupPrice),
        lanes_(lanes) {
    for (Lane& lane : lanes_) lane.krylov = make_krylov();
  }

  std::string name() const override { return "block"; }
  bool shares_factors() const override { return true; }

  Status setup(const BlockJacobian& J, int) override {
    const ScopedTimer timer(shared_.seconds());
    shared_.begin(J.shift);
    const Status status = preconditioner_.setup(J, *team_);
    if (status.ok()) shared_.succeed();
    return status;
  }

  bool wants_setup(const BlockJacobian& J, int) const override { return shared_.worn(J.shift); }

  SolveReport solve(const BlockJacobian& J, VecView b, VecRef x, double tolerance,
                    int lane_number) override {
    Lane& lane = lanes_[lane_number];
    LinearStatistics& statistics = shared_.of_lane(lane_number);
    const ScopedTimer timer(statistics.solve_seconds);
    ++statistics.solves;
    if (!shared_.ready()) return {Status::retry("there are no factors")};
    const int n = J.block_size();
    const double row_scale = J.shift > 0 ? 1 / J.shift : 1.0;
    const auto apply = [&](VecView in, VecRef out) {
      J.multiply(in, out, *team_);
      out.head(n) *= row_scale;
      return Status{};
    };
    const auto precondition = [&](VecView in, VecRef out) {
      lane.scaled = in;
      lane.scaled.head(n) /= row_scale;
      preconditioner_.apply(J, lane.scaled, out, *team_, lane_number);
      return Status{};
    };
    lane.right = b;
    lane.right.head(n) *= row_scale;
    SolveReport report =
        lane.krylov->solve(apply, precondition, lane.right, x, tolerance, kMaxIterations);
    shared_.count(lane_number, report.iterations);
    report.status = judged_by_residual(report.status, J, b, x, tolerance, *team_);
    if (report.status.ok()) restore_mass(J, b, x);
    return report;
  }

  LinearStatistics statistics() const override { return shared_.statistics(); }
  void save(CheckpointOut out) const override { shared_.save(out); }
  void load(CheckpointIn in) override { shared_.load(in); }

 private:
  struct Lane {
    std::unique_ptr<KrylovMethod> krylov;
    Vec right, scaled;
  };

  TwoSolvePreconditioner preconditioner_;
  std::shared_ptr<const ThreadTeam> team_;
  SharedSetup shared_;
  std::vector<Lane> lanes_;
};

}  // namespace

LinearSolverPtr make_block_solver(const SpdSolverFactory& make_spd_solver,
                                  const KrylovFactory& make_krylov,
                                  std::shared_ptr<const ThreadTeam> team, int lanes) {
  return std::make_unique<BlockSolver>(make_spd_solver, make_krylov, std::move(team), lanes);
}

}  // namespace traceraft::linear
