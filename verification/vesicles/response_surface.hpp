// A parabola in several variables through values that scatter.
#pragma once

#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft {

class ResponseSurface {
 public:
  // Weighted least squares of a + g·x + ½ xᵀHx. At least (p + 1)(p + 2)/2 points for p variables,
  // in general position. Throws std::invalid_argument if they are too few.
  ResponseSurface(const std::vector<std::vector<double>>& x, const std::vector<double>& values,
                  const std::vector<double>& weights);

  double at(const std::vector<double>& x) const;
  // Its smallest value within the box.
  std::vector<double> minimiser(const std::vector<double>& lower,
                                const std::vector<double>& upper) const;

 private:
  int variables_;
  Vec coefficients_;
};

// The number of points that it takes.
constexpr int points_of_surface(int variables) {
  return (variables + 1) * (variables + 2) / 2;
}

}  // namespace traceraft
