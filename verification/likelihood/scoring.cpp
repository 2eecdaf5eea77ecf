#include "verification/likelihood/scoring.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace traceraft::likelihood {
namespace {

constexpr int kMostIterations = 60;
constexpr double kTolerance = 1e-4;  // of the deviance
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-6, kMostDamping = 1e6;
constexpr double kHardlyDamped = 1e-2;  // a damped step may be short for that reason alone
constexpr double kLongestStep = 1, kRoundoff = 1e-9;
constexpr double kLeastCurvature = 1e-12;  // where a likelihood is flat

// A parameter that would leave its bounds stays where it is.
Vec scoring_step(const ScoringProblem& problem, const ScoredMinimum& here, double damping) {
  Vec gradient = here.at.gradient;
  Eigen::MatrixXd hessian = here.at.hessian;
  hessian.diagonal() *= 1 + damping;
  hessian.diagonal().array() += kLeastCurvature;
  for (Eigen::Index p = 0; p < gradient.size(); ++p) {
    const double edge = kRoundoff * (problem.upper[p] - problem.lower[p]);
    const bool leaves =
        gradient[p] > 0 ? here.x[p] < problem.lower[p] + edge : here.x[p] > problem.upper[p] - edge;
    if (!leaves) continue;
    gradient[p] = 0;
    hessian.row(p).setZero();
    hessian.col(p).setZero();
    hessian(p, p) = 1;
  }
  // Each by itself: one of which nothing is known is not to hold up the others.
  return (-hessian.ldlt().solve(gradient)).cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
}

}  // namespace

ScoredMinimum minimise_by_scoring(const ScoringProblem& problem, const Vec& start) {
  const auto bounded = [&](const Vec& x) -> Vec {
    return x.cwiseMax(problem.lower).cwiseMin(problem.upper);
  };
  ScoredMinimum here{bounded(start), {}};
  here.at = problem.deviance(here.x);
  double damping = kFirstDamping;
  for (int k = 0; k < kMostIterations && damping <= kMostDamping; ++k) {
    const Vec x = bounded(here.x + scoring_step(problem, here, damping));
    const DevianceExpansion next = problem.deviance(x);
    const double gain = here.at.value - next.value;
    if (!(gain > 0)) {
      damping *= 8;
      continue;
    }
    here = {x, next};
    damping = std::max(0.1 * damping, kLeastDamping);
    if (gain < kTolerance && damping < kHardlyDamped) break;
  }
  return here;
}

}  // namespace traceraft::likelihood
