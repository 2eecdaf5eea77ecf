// Minima of functions without derivatives, by NLopt.
#pragma once

#include <functional>
#include <vector>

namespace traceraft::nlopt {

struct MinimiseRequest {
  std::function<double(const std::vector<double>&)> function;  // finite values
  std::vector<double> start, lower, upper;                     // lower ≤ start ≤ upper
  std::vector<double> step;                                    // first step in each direction, > 0
  double tolerance = 1e-6;                                     // in x, in units of upper − lower
  int most_evaluations = 1000;
};

struct Minimum {
  std::vector<double> x;
  double value;
  int evaluations;
  bool converged;  // to the tolerance, before the evaluations ran out
};

// A local minimum within the bounds: Rowan's subplex (SBPLX), robust against functions that are
// noisy or not smooth. Throws what the function throws, std::runtime_error if NLopt fails.
Minimum minimise(const MinimiseRequest& request);

}  // namespace traceraft::nlopt
