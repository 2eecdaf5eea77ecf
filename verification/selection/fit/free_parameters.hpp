// The parameters of a found model that the data may still move.
#pragma once

#include <vector>

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::selection {

// The parameters of `pass` that belong to a model with this hypothesis (diffusion ratio, error of
// the mesh, coefficients), without the coefficients at an end of their range that the likelihood, a
// Gaussian to first order, would push beyond it: the others have their optimum with these held
// where they are. `pass`: of that model.
std::vector<Eigen::Index> free_parameters(const assimilation::FilterResult& pass,
                                          const assimilation::Hypothesis& hypothesis);

// The inverse of the information: of the free parameters with the others held, and of each of the
// others, if it were free, without correlations.
Eigen::MatrixXd covariance_beside_held(const Eigen::MatrixXd& information,
                                       const std::vector<Eigen::Index>& free);

// Where that optimum is: the change of each of the free parameters.
Vec newton_step(const assimilation::FilterResult& pass, const std::vector<Eigen::Index>& free);

}  // namespace traceraft::selection
