// How strong effects that were not found may be.
#pragma once

#include <string>
#include <vector>

#include "verification/selection/fit/score_test.hpp"

namespace traceraft::selection {

// Bounds of the first parameter of an effect, in units of R and R²/D, with 95 % confidence.
struct Bound {
  std::string effect;
  double low,  // 0 for effects that have one sign
      high;    // the upper bound
  bool seen;   // does anything that was measured depend on it? If not, there is no bound
};

// Between a strength, or a sum of the coefficients of so many directions, and its 95 % bounds.
// Where noise alone gains more than it should (`null_mean`), its spread is widened accordingly.
double bound_width(double deviation, int directions, bool two_sided, double null_mean);

// The bounds of the screened effects, to first order.
std::vector<Bound> bounds_of(const Screening& screening,
                             const std::vector<assimilation::Candidate>& screened);

}  // namespace traceraft::selection
