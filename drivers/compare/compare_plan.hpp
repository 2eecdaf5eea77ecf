// The plan of a comparison, from what the user asks for and what its folder holds already.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"

namespace traceraft::compare {

// The request on the command line.
struct CompareRequest {
  config::GivenValues flags;
  std::string config_file;
  std::string out;                             // "" for the first free runs/compare-<case>-N
  std::string references = "runs/references";  // where reference solutions are kept
  // Comma-separated; "": what the comparison in `out` has, or defaults.
  std::string integrators, linear_solvers, tolerances, ranks;
  // 0 or, for the time limit, negative: likewise.
  int repeat = 0;
  double time_limit = -1, target_error = -1, reference_tolerance = 0;
  bool quiet = false;
};

inline constexpr double kLeastTolerance = 1e-12, kLargestTolerance = 0.5;
inline constexpr int kMostRanks = 4096, kMostRepetitions = 1000;

struct ComparePlan {
  std::vector<std::string> integrators, linear_solvers;
  std::vector<double> tolerances;
  std::vector<int> ranks;  // more than one for the solvers that can
  int repeat = 3;
  double reference_tolerance = 0;   // 0: a hundredth of the smallest tolerance
  double time_limit = 0;            // seconds per run; 0: none
  double target_error = 0;          // 0: the smallest that all methods reach
  std::uint32_t initial_state = 0;  // its checksum: of runs that restart from others
  std::string program;              // checksum of the one that makes the runs

  double reference() const;  // the tolerance of the reference
};

// `before`, the plan of a comparison that goes on, or null, with what is asked for now: lists grow,
// numbers are replaced. Throws InputError.
ComparePlan extended_plan(const CompareRequest& request, const ComparePlan* before);

// One combination of the plan, run once.
struct CompareJob {
  std::string integrator, linear_solver;
  double tolerance;
  int ranks;
  int repetition;  // from 1
  std::string name() const;
};

// Repetition by repetition, so that a machine that changes its speed changes it for all.
std::vector<CompareJob> jobs_of(const ComparePlan& plan);

}  // namespace traceraft::compare
