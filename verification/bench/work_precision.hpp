// The cost of a solution and its accuracy: many methods on one problem, and which to take.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "verification/statistics/sample.hpp"

namespace traceraft::bench {

// A method at one tolerance.
struct WorkPoint {
  std::string integrator, linear_solver;
  double tolerance = 0;
  std::string failure;                // why there is no result; "" if there is one
  double error = 0;                   // against the reference, relative in L²(Γ)
  std::vector<double> cpu_s, wall_s;  // of each repetition
  // From the summary of a run: steps, rejected, residuals, mass_drift, peak_memory_mb, …
  std::map<std::string, double> counts;
  int ranks = 1;

  bool ok() const { return failure.empty(); }
  std::string method() const {
    return integrator + " with " + linear_solver +
           (ranks > 1 ? " on " + std::to_string(ranks) + " ranks" : "");
  }
};

bool any_result(const std::vector<WorkPoint>& points);

// The advice that follows from the numbers.
struct Recommendation {
  double target = 0;          // error that was asked for, or the smallest that every method reached
  std::vector<int> cheapest;  // per method that reached it: its point of least median wall time,
                              // the cheapest method first
  std::vector<std::string> missed;  // methods without a point at the target
  std::string sentence;
};

// target_error 0: the smallest error that all methods with a result have reached.
Recommendation recommend(const std::vector<WorkPoint>& points, double target_error);

}  // namespace traceraft::bench
