#include "kernel/linear/block_solver.hpp"

#include <algorithm>
#include <vector>

#include "kernel/core/stopwatch.hpp"
#include "kernel/linear/setup_policy.hpp"
#include "kernel/linear/two_solve_preconditioner.hpp"

namespace traceraft {
namespace {

constexpr int kMaxIterations = 200;
// Measured at n = 128: a set-up costs about as much as 12 iterations.
constexpr long kSetupPrice = 12;

class BlockSolver final : public LinearSolver {
 public:
  BlockSolver(const SpdSolverFactory& make_spd_solver, const KrylovFactory& make_krylov,
              std::shared_ptr<const ThreadTeam> team, int lanes)
      : preconditioner_(make_spd_solver, lanes), team_(std::move(team)), lanes_(lanes) {
    for (Lane& lane : lanes_) lane.krylov = make_krylov();
  }

  std::string name() const override { return "block"; }
  bool shares_factors() const override { return true; }

  Status setup(const BlockJacobian& J, int) override {
    const ScopedTimer timer(setup_seconds_);
    ++setups_;
    for (Lane& lane : lanes_) lane.effort = {};
    const Status status = preconditioner_.setup(J, *team_);
    ready_ = status.ok();
    setup_shift_ = J.shift;
    return status;
  }

  bool wants_setup(const BlockJacobian& J, int) const override {
    long extra = 0;
    for (const Lane& lane : lanes_) extra += lane.effort.extra;
    return !ready_ || is_worn(setup_shift_, J.shift, extra, kSetupPrice);
  }

  SolveReport solve(const BlockJacobian& J, ConstVec b, VecRef x, double tolerance,
                    int lane_number) override {
    Lane& lane = lanes_[lane_number];
    const ScopedTimer timer(lane.statistics.solve_seconds);
    ++lane.statistics.solves;
    if (!ready_) return {Status::retry("there are no factors")};
    const int n = J.block_size();
    const double row_scale = J.shift > 0 ? 1 / J.shift : 1.0;
    const auto apply = [&](ConstVec in, VecRef out) {
      J.multiply(in, out, *team_);
      out.head(n) *= row_scale;
      return Status{};
    };
    const auto precondition = [&](ConstVec in, VecRef out) {
      lane.scaled = in;
      lane.scaled.head(n) /= row_scale;
      preconditioner_.apply(J, lane.scaled, out, *team_, lane_number);
      return Status{};
    };
    lane.right = b;
    lane.right.head(n) *= row_scale;
    SolveReport report =
        lane.krylov->solve(apply, precondition, lane.right, x, tolerance, kMaxIterations);
    lane.count(report.iterations);
    if (report.status.ok()) restore_mass(J, b, x);
    return report;
  }

  LinearStatistics statistics() const override {
    LinearStatistics total;
    for (const Lane& lane : lanes_) total = total + lane.statistics;
    total.setups = setups_;
    total.setup_seconds = setup_seconds_;
    return total;
  }

  void save(CheckpointOut out) const override {
    write_binary(out, setups_);
    write_binary(out, setup_seconds_);
    for (const Lane& lane : lanes_) {
      write_binary(out, lane.effort);
      write_binary(out, lane.statistics);
    }
  }
  void load(CheckpointIn in) override {
    read_binary(in, setups_);
    read_binary(in, setup_seconds_);
    for (Lane& lane : lanes_) {
      read_binary(in, lane.effort);
      read_binary(in, lane.statistics);
    }
  }

 private:
  struct Lane {
    std::unique_ptr<KrylovMethod> krylov;
    Effort effort;
    LinearStatistics statistics;
    Vec right, scaled;

    void count(int iterations) {
      statistics.iterations += iterations;
      statistics.most_iterations = std::max(statistics.most_iterations, iterations);
      effort.count(iterations);
    }
  };

  TwoSolvePreconditioner preconditioner_;
  std::shared_ptr<const ThreadTeam> team_;
  std::vector<Lane> lanes_;
  bool ready_ = false;
  double setup_shift_ = 0;
  long setups_ = 0;
  double setup_seconds_ = 0;
};

}  // namespace

LinearSolverPtr make_block_solver(const SpdSolverFactory& make_spd_solver,
                                  const KrylovFactory& make_krylov,
                                  std::shared_ptr<const ThreadTeam> team, int lanes) {
  return std::make_unique<BlockSolver>(make_spd_solver, make_krylov, std::move(team), lanes);
}

}  // namespace traceraft
