// What a refit solves for: ln pace, then all coefficients; rates in units of time of the base
// model, as what data tell of a rate then hardly depends on the pace.
#pragma once

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft {

// Factors from the coefficients to the unknowns; the first, of the pace, is 1.
Vec unknown_factors(const Hypothesis& hypothesis, double pace);

Vec unknowns(const FilterModel& model);
void set_unknowns(FilterModel& model, const Vec& x);  // coefficients within their ranges

// With another pace, and rates as they are in units of time that do not change.
FilterModel at_pace(FilterModel model, double pace);
// With its effects so many times as strong.
FilterModel with_strengths(double factor, FilterModel model);

// Derivatives of the unknowns by ln pace and the coefficients.
Eigen::MatrixXd unknown_derivatives(const FilterModel& model);

// Where the pace and the coefficients are among the parameters of a pass.
std::vector<Eigen::Index> own_parameters(const Hypothesis& hypothesis);

}  // namespace traceraft
