#include "backends/suitesparse/supernodal_solver.hpp"

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "backends/suitesparse/blas.hpp"
#include "backends/suitesparse/supernodal_factor.hpp"

namespace traceraft {
namespace {

class SupernodalSolver final : public SpdSolver {
 public:
  SupernodalSolver(std::shared_ptr<const SupernodalStructure> structure, int lanes)
      : factor_(std::move(structure)), work_(lanes) {}

  Status factorise(const CsrMatrix& A) override {
    if (factor_.factorise(A.values)) return {};
    return Status::retry("the matrix is not positive definite");
  }

  void solve(ConstVec b, VecRef x, const ThreadTeam& team, int lane) override {
    factor_.solve(b, x, team, work_[lane]);
  }

 private:
  SupernodalFactor factor_;
  std::vector<SupernodalFactor::Work> work_;
};

}  // namespace

SpdSolverFactory supernodal_factory(PatternPtr pattern) {
  use_one_blas_thread();
  struct Analysis {
    std::once_flag once;
    std::shared_ptr<const SupernodalStructure> structure;
  };
  return [pattern, analysis = std::make_shared<Analysis>()](int lanes) -> SpdSolverPtr {
    std::call_once(analysis->once, [&] { analysis->structure = analyse(*pattern); });
    return std::make_unique<SupernodalSolver>(analysis->structure, lanes);
  };
}

}  // namespace traceraft
