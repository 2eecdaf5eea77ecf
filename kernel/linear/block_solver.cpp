#include "kernel/linear/block_solver.hpp"

#include <algorithm>

#include "kernel/core/binary.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/linear/two_solve_preconditioner.hpp"

namespace traceraft {
namespace {

constexpr int kMaxIterations = 200;
// Measured at n = 128: a set-up costs about as much as 15 iterations. Counts decide, not clocks, so
// that runs repeat themselves.
constexpr long kSetupPrice = 15;

class BlockSolver final : public LinearSolver {
 public:
  BlockSolver(const SpdSolverFactory& make_spd_solver, std::unique_ptr<KrylovMethod> krylov,
              std::shared_ptr<const ThreadTeam> team)
      : preconditioner_(make_spd_solver), krylov_(std::move(krylov)), team_(std::move(team)) {}

  std::string name() const override { return "block"; }

  Status setup(const BlockJacobian& J) override {
    const ScopedTimer timer(statistics_.setup_seconds);
    ++statistics_.setups;
    best_ = -1;
    extra_ = 0;
    const Status status = preconditioner_.setup(J, *team_);
    ready_ = status.ok();
    setup_shift_ = J.shift;
    return status;
  }

  bool wants_setup(const BlockJacobian& J) const override {
    const double change = J.shift / setup_shift_;
    return !ready_ || !(change < 4 && change > 0.25) || extra_ >= kSetupPrice;
  }

  SolveReport solve(const BlockJacobian& J, ConstVec b, VecRef x, double tolerance) override {
    const ScopedTimer timer(statistics_.solve_seconds);
    ++statistics_.solves;
    const int n = J.block_size();
    const double row_scale = J.shift > 0 ? 1 / J.shift : 1.0;
    const auto apply = [&](ConstVec in, VecRef out) {
      J.multiply(in, out, *team_);
      out.head(n) *= row_scale;
      return Status{};
    };
    const auto precondition = [&](ConstVec in, VecRef out) {
      scaled_ = in;
      scaled_.head(n) /= row_scale;
      preconditioner_.apply(J, scaled_, out, *team_);
      return Status{};
    };
    Vec right = b;
    right.head(n) *= row_scale;
    SolveReport report = krylov_->solve(apply, precondition, right, x, tolerance, kMaxIterations);
    statistics_.iterations += report.iterations;
    statistics_.most_iterations = std::max(statistics_.most_iterations, report.iterations);
    if (best_ < 0 || report.iterations < best_) best_ = report.iterations;
    extra_ += report.iterations - best_;
    if (report.status.ok()) restore_mass(J, b, x);
    return report;
  }

  LinearStatistics statistics() const override { return statistics_; }

  void save(std::ostream& out) const override {
    write_binary(out, best_);
    write_binary(out, extra_);
    write_binary(out, statistics_);
  }
  void load(std::istream& in) override {
    read_binary(in, best_);
    read_binary(in, extra_);
    read_binary(in, statistics_);
  }

 private:
  TwoSolvePreconditioner preconditioner_;
  std::unique_ptr<KrylovMethod> krylov_;
  std::shared_ptr<const ThreadTeam> team_;
  LinearStatistics statistics_;
  bool ready_ = false;
  double setup_shift_ = 0;
  long best_ = -1;  // fewest iterations since the last set-up
  long extra_ = 0;  // iterations beyond that, summed
  Vec scaled_;
};

}  // namespace

LinearSolverPtr make_block_solver(const SpdSolverFactory& make_spd_solver,
                                  std::unique_ptr<KrylovMethod> krylov,
                                  std::shared_ptr<const ThreadTeam> team) {
  return std::make_unique<BlockSolver>(make_spd_solver, std::move(krylov), std::move(team));
}

}  // namespace traceraft
