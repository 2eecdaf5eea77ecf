// Runs that differ in their seed only, and power laws fitted to all of them together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verification/bench/bench.hpp"
#include "verification/statistics/bootstrap.hpp"

namespace traceraft::bench {

struct EnsembleRequest {
  std::string mobility;
  double raft_fraction;
  int cells;
  double epsilon, t_end;
  double tolerance;
  int members;
  std::vector<double> times;           // common to all, ascending, within (0, t_end]
  std::vector<double> snapshot_times;  // of spectra and raft areas
  std::vector<problem::EffectPtr> effects = {};
  int highest_degree = 0;  // of the spectra; 0: none
  Part part = {};          // of the study
};

struct Member {
  std::vector<double> perimeter, rafts, raft_radius;  // at the common times
  std::vector<std::vector<double>> spectra, areas;    // at the times of the snapshots
  double steps = 0;
};

// Seeds 1, 2, …; members run side by side. perimeter: length of the level curve c = ½; raft_radius:
// √(mean area/π).
std::vector<Member> run_ensemble(const Bench& bench, const EnsembleRequest& request);

// exp of the mean over the members of ln(quantity) at each of the common times. `sample`: which
// members, with repetition.
std::vector<double> geometric_mean(const std::vector<Member>& members,
                                   std::vector<double> Member::*quantity,
                                   const std::vector<int>& sample);

// The exponent b of quantity ~ t^b, or of (t + offset)^b with the offset fitted as well, over the
// common times in [begin, end]; its 95 % interval by the bootstrap over members, which
// are few.
struct Exponent {
  double b, offset;
  statistics::Interval interval;
};
enum class Origin { zero, fitted };
Exponent fit_exponent(const std::vector<Member>& members, std::vector<double> Member::*quantity,
                      const std::vector<double>& times, double begin, double end, Origin origin);

}  // namespace traceraft::bench
