// The unknowns that a refit solves for: ln diffusion ratio, then all coefficients. Rates are in
// units of time of the base model, as what data tell of a rate then hardly depends on the diffusion
// ratio.
#pragma once

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::selection {

// Factors from the coefficients to the unknowns; the first, of the diffusion ratio, is 1.
Vec unknown_factors(const assimilation::Hypothesis& hypothesis, double diffusion_ratio);

Vec unknowns(const assimilation::FilterModel& model);
void set_unknowns(assimilation::FilterModel& model,
                  const Vec& x);  // coefficients within their ranges

// The model with another diffusion ratio, and rates as they are in units of time that do not
// change.
assimilation::FilterModel at_diffusion_ratio(assimilation::FilterModel model,
                                             double diffusion_ratio);
// The model with its effects `factor` times as strong.
assimilation::FilterModel with_strengths(double factor, assimilation::FilterModel model);

// Derivatives of the unknowns by ln diffusion ratio and the coefficients.
Eigen::MatrixXd unknown_derivatives(const assimilation::FilterModel& model);

// Where the diffusion ratio and the coefficients are among the parameters of a pass.
std::vector<Eigen::Index> own_parameters(const assimilation::Hypothesis& hypothesis);

}  // namespace traceraft::selection
