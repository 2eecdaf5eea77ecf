// A smooth function of a few variables between values at scattered points.
#pragma once

#include <vector>

namespace traceraft::calibration {

// Local quadratic regression (Cleveland, Devlin 1988): the value at `at` of the parabola that fits
// values at the points best, those at a distance d counting exp(−d²/(2 width²)) times as much. It
// is linear in the values: the result holds what each of them is multiplied by, and sums to 1. At
// least points_of_parabola(variables) points in general position. Throws std::invalid_argument if
// they are too few.
std::vector<double> regression_weights(const std::vector<std::vector<double>>& points,
                                       const std::vector<double>& at, double width);

// The number of points that it takes.
constexpr int points_of_parabola(int variables) {
  return (variables + 1) * (variables + 2) / 2;
}

}  // namespace traceraft::calibration
