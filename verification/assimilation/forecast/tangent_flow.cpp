#include "verification/assimilation/forecast/tangent_flow.hpp"

#include <algorithm>
#include <stdexcept>

#include "verification/bench/bench.hpp"

namespace traceraft::assimilation {
namespace {

// Factors of the exact tangent solve to roundoff; more than this says that they are no factors.
constexpr double kSolveTolerance = 1e-7;
constexpr double kRefined = 1e-5;
constexpr int kMostRefinements = 30;

bool is_assembled(const problem::CahnHilliardModel& model) {
  return std::all_of(
      model.effects.begin(), model.effects.end(),
      [](const problem::EffectPtr& effect) { return effect->tangent_is_assembled(); });
}

}  // namespace

TangentFlow::TangentFlow(const problem::CahnHilliard& problem,
                         const linear::LinearSolverFactory& make_solver,
                         std::shared_ptr<const ThreadTeam> team)
    : problem_(problem),
      team_(std::move(team)),
      solver_(make_solver(team_->size())),
      jacobian_(problem.make_jacobian()),
      is_assembled_(is_assembled(problem.model())) {}

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

Columns TangentFlow::solve_stage(double t, VecView y, double shift, const Columns& G,
                                 const Forcing& forcing) {
  const int n = problem_.block_size();
  const Vec no_rate = Vec::Zero(problem_.size());
  bench::require(problem_.jacobian(t, y, no_rate, shift, linear::Tangent::exact, jacobian_));
  const Columns forced = forcing ? forcing(t, y) : Columns();
  const Eigen::Index free = G.cols() - forced.cols();
  Columns right = Columns::Zero(2 * n, G.cols());
  team_->run([&](int lane) {
    const ThreadTeam alone(1);
    Vec mass_column(n);
    for (Eigen::Index k = lane; k < G.cols(); k += team_->size()) {
      problem_.space().stabilised_mass.multiply(G.col(k), mass_column, alone);
      right.col(k).head(n) = shift * mass_column;
      if (k >= free) right.col(k) -= forced.col(k - free);
    }
    if (lane < G.cols()) bench::require(solver_->setup(jacobian_, lane));
  });
  Columns X = solve(right);
  if (!is_assembled_) refine(t, y, shift, right, X);
  return X.topRows(n);
}

Columns TangentFlow::solve(const Columns& right) {
  Columns X(right.rows(), right.cols());
  team_->run([&](int lane) {
    for (Eigen::Index k = lane; k < right.cols(); k += team_->size()) {
      Vec x = Vec::Zero(right.rows());
      const Vec column = right.col(k);
      if (!column.isZero(0))
        bench::require(solver_->solve(jacobian_, column, x, kSolveTolerance, lane).status);
      X.col(k) = x;
    }
  });
  return X;
}

void TangentFlow::refine(double t, VecView y, double shift, const Columns& right, Columns& X) {
  const Vec no_rate = Vec::Zero(problem_.size());
  Columns left(right.rows(), right.cols());
  for (int k = 0; k < kMostRefinements; ++k) {
    Vec product(right.rows());
    bool done = true;
    for (Eigen::Index j = 0; j < right.cols(); ++j) {
      bench::require(problem_.jacobian_product(t, y, no_rate, shift, linear::Tangent::exact,
                                               X.col(j), product));
      left.col(j) = right.col(j) - product;
      done = done && left.col(j).norm() <= kRefined * right.col(j).norm();
    }
    if (done) return;
    X += solve(left);
  }
  throw std::runtime_error("perturbations do not converge where distant points are coupled");
}

}  // namespace traceraft::assimilation
