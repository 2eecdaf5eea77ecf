// Fisher's scoring: maximum likelihood by Newton's method with the expected second derivatives
// (McCullagh and Nelder, "Generalized Linear Models", 1989, section 2.5).
#pragma once

#include <functional>

#include "kernel/core/types.hpp"

namespace traceraft::likelihood {

// A deviance, −2 ln of a likelihood, around a point, with an entry per parameter.
struct DevianceExpansion {
  double value;
  Vec gradient;
  Eigen::MatrixXd hessian;  // the expected one: twice Fisher's information
};

struct ScoringProblem {
  std::function<DevianceExpansion(const Vec&)> deviance;
  Vec lower, upper;  // bounds of each parameter
};

struct ScoredMinimum {
  Vec x;
  DevianceExpansion at;
};

// A local minimum within the bounds. Steps are damped as Levenberg and Marquardt do until the
// deviance falls.
ScoredMinimum minimise_by_scoring(const ScoringProblem& problem, const Vec& start);

}  // namespace traceraft::likelihood
