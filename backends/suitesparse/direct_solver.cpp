#include "backends/suitesparse/direct_solver.hpp"

#include <algorithm>
#include <memory>
#include <mutex>

#include "backends/suitesparse/blas.hpp"
#include "backends/suitesparse/ordering.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft::suitesparse {
namespace {

// One, and as many refinements as have ever helped a system that is not singular.
constexpr int kMostSolves = 3;

// METIS draws from the process-wide random numbers of the C library: ordering once, for all lanes,
// keeps two threads from sharing them and a resumed run on the same order.
class SharedOrdering {
 public:
  // (c, μ) pairs of nodes in METIS' order of the nodes.
  const std::vector<int>& of(const fem::SparsityPattern& pattern) {
    std::call_once(once_, [&] {
      for (const int i : metis_ordering(pattern))
        pairs_.insert(pairs_.end(), {i, i + pattern.rows()});
    });
    return pairs_;
  }

 private:
  std::once_flag once_;
  std::vector<int> pairs_;
};

// The factors of one lane. Nothing is allocated before the first set-up: a fallback may never be
// needed.
class Lane {
 public:
  Lane(const std::string& name, std::unique_ptr<SparseLu> lu, const fem::PatternPtr& pattern,
       std::shared_ptr<SharedOrdering> ordering)
      : name_(name),
        lu_(std::move(lu)),
        pattern_(pattern),
        system_(pattern),
        ordering_(std::move(ordering)) {}

  linear::LinearStatistics statistics;

  Status setup(const linear::BlockJacobian& J) {
    const ScopedTimer timer(statistics.setup_seconds);
    ++statistics.setups;
    ready_ = false;
    if (!(J.shift > 0)) return Status::fatal(name_ + ": the shift must be positive");
    system_.fill(J);
    const Status status = lu_->factorise(system_, ordering_->of(*pattern_));
    ready_ = status.ok();
    return status;
  }

  // The contract: never report a wrong x as ok. LU of a poorly scaled system is checked, too, and
  // refined if it has to be.
  linear::SolveReport solve(const linear::BlockJacobian& J, VecView b, VecRef x, double tolerance) {
    const ScopedTimer timer(statistics.solve_seconds);
    ++statistics.solves;
    if (!ready_) return {Status::retry(name_ + ": there is no factorisation")};
    const double size = linear::scaled_norm(J, b);
    Vec defect = b, correction(b.size());
    x.setZero();
    double relative = 1;
    for (int solves = 1; solves <= kMostSolves; ++solves) {
      if (const Status status = solve_factors(J, defect, correction); !status.ok())
        return {status, solves};
      x += correction;
      ++statistics.iterations;
      statistics.most_iterations = std::max(statistics.most_iterations, solves);
      J.multiply(x, defect, ThreadTeam(1));
      defect = b - defect;
      relative = linear::scaled_norm(J, defect) / size;
      if (size == 0 || relative <= tolerance) return {{}, solves};
    }
    return {Status::retry(name_ + ": relative residual " + format_number(relative)), kMostSolves};
  }

 private:
  Status solve_factors(const linear::BlockJacobian& J, VecView b, Vec& x) {
    Vec solution;
    const Status status = lu_->solve(system_, system_.right_side(J, b), solution);
    if (status.ok()) system_.take_solution(J, b, solution, x);
    return status;
  }

  std::string name_;
  std::unique_ptr<SparseLu> lu_;
  fem::PatternPtr pattern_;
  AssembledSystem system_;
  std::shared_ptr<SharedOrdering> ordering_;
  bool ready_ = false;
};

class DirectSolver final : public linear::LinearSolver {
 public:
  DirectSolver(const std::string& name, const SparseLuFactory& make_lu,
               const fem::PatternPtr& pattern, int lanes)
      : name_(name) {
    use_one_blas_thread();
    const auto ordering = std::make_shared<SharedOrdering>();
    for (int lane = 0; lane < lanes; ++lane)
      lanes_.push_back(std::make_unique<Lane>(name, make_lu(), pattern, ordering));
  }
  std::string name() const override { return name_; }
  bool shares_factors() const override { return false; }
  bool wants_setup(const linear::BlockJacobian&, int) const override { return true; }
  Status setup(const linear::BlockJacobian& J, int lane) override { return lanes_[lane]->setup(J); }
  linear::SolveReport solve(const linear::BlockJacobian& J, VecView b, VecRef x, double tolerance,
                            int lane) override {
    return lanes_[lane]->solve(J, b, x, tolerance);
  }
  linear::LinearStatistics statistics() const override {
    linear::LinearStatistics total;
    for (const auto& lane : lanes_) total = total + lane->statistics;
    return total;
  }
  void save(CheckpointOut out) const override {
    for (const auto& lane : lanes_) write_binary(out, lane->statistics);
  }
  void load(CheckpointIn in) override {
    for (const auto& lane : lanes_) read_binary(in, lane->statistics);
  }

 private:
  std::string name_;
  std::vector<std::unique_ptr<Lane>> lanes_;
};

}  // namespace

linear::LinearSolverPtr make_direct_solver(const std::string& name, const SparseLuFactory& make_lu,
                                           const fem::PatternPtr& pattern, int lanes) {
  return std::make_unique<DirectSolver>(name, make_lu, pattern, lanes);
}

}  // namespace traceraft::suitesparse
