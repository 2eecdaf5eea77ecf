#include "verification/explain/forecast/tangent_flow.hpp"

#include <stdexcept>

#include "verification/measure/bench.hpp"

namespace traceraft {
namespace {

// Factors of the exact tangent solve to roundoff; more than this says that they are no factors.
constexpr double kSolveTolerance = 1e-7;

}  // namespace

TangentFlow::TangentFlow(const CahnHilliard& problem, const LinearSolverFactory& make_solver,
                         std::shared_ptr<const ThreadTeam> team)
    : problem_(problem),
      team_(std::move(team)),
      solver_(make_solver(team_->size())),
      jacobian_(problem.make_jacobian()) {}

void TangentFlow::advance(const TangentPath& along, Columns& S, const Forcing& forcing) {
  for (std::size_t k = 0; k < along.grid.steps.size(); ++k) {
    const double shift = 1 / (kTangentGamma * along.grid.steps[k]);
    const auto stage = [&](std::size_t i, const Columns& known) {
      return solve_stage(along.grid.stage_times[2 * k + i], along.stages[2 * k + i], shift, known,
                         forcing);
    };
    const Columns first = stage(0, S);
    S = stage(1, S + (1 - kTangentGamma) / kTangentGamma * (first - S));
  }
}

Columns TangentFlow::solve_stage(double t, ConstVec y, double shift, const Columns& G,
                                 const Forcing& forcing) {
  const SurfaceSpace& space = problem_.space();
  const int n = problem_.block_size();
  const Vec no_rate = Vec::Zero(problem_.size());
  require(problem_.jacobian(t, y, no_rate, shift, Tangent::exact, jacobian_));
  const Columns forced = forcing ? forcing(t, y) : Columns();
  const Eigen::Index free = G.cols() - forced.cols();
  Columns X(n, G.cols());
  const auto column = [&](Eigen::Index k, int lane) {
    const ThreadTeam alone(1);
    Vec right = Vec::Zero(2 * n), x = Vec::Zero(2 * n);
    Vec mass_column(n);
    space.stabilised_mass.multiply(G.col(k), mass_column, alone);
    right.head(n) = shift * mass_column;
    if (k >= free) right -= forced.col(k - free);
    if (right.isZero(0)) {
      X.col(k).setZero();
      return;
    }
    require(solver_->solve(jacobian_, right, x, kSolveTolerance, lane).status);
    X.col(k) = x.head(n);
  };
  team_->run([&](int lane) {
    if (lane >= G.cols()) return;
    require(solver_->setup(jacobian_, lane));
    for (Eigen::Index k = lane; k < G.cols(); k += team_->size()) column(k, lane);
  });
  return X;
}

}  // namespace traceraft
