// The records of solvers whose lanes share one approximate inverse: when it has become dearer than
// a new one, and what has been done with it.
#pragma once

#include <algorithm>
#include <vector>

#include "kernel/linear/linear_solver.hpp"

namespace traceraft::linear {

// Counts decide, not clocks, so that runs repeat themselves. Lanes may count at the same time.
class SharedSetup {
 public:
  // `price`: what a set-up costs, in iterations.
  SharedSetup(int lanes, long price) : price_(price), lanes_(static_cast<std::size_t>(lanes)) {}

  // A set-up for this shift begins; until it succeeds there is no inverse.
  void begin(double shift) {
    ++setups_;
    for (Lane& lane : lanes_) lane.effort = {};
    shift_ = shift;
    ready_ = false;
  }
  void succeed() { ready_ = true; }
  bool ready() const { return ready_; }
  double& seconds() { return seconds_; }

  LinearStatistics& of_lane(int lane) { return lanes_[lane].statistics; }
  void count(int lane_number, int iterations) {
    Lane& lane = lanes_[lane_number];
    lane.statistics.iterations += iterations;
    lane.statistics.most_iterations = std::max(lane.statistics.most_iterations, iterations);
    lane.effort.count(iterations);
  }

  bool worn(double shift) const {
    const double change = shift / shift_;
    long extra = 0;
    for (const Lane& lane : lanes_) extra += lane.effort.extra;
    return !ready_ || !(change < 4 && change > 0.25) || extra >= price_;
  }

  LinearStatistics statistics() const {
    LinearStatistics total;
    for (const Lane& lane : lanes_) total = total + lane.statistics;
    total.setups = setups_;
    total.setup_seconds = seconds_;
    return total;
  }

  void save(CheckpointOut out) const {
    write_binary(out, setups_);
    write_binary(out, seconds_);
    for (const Lane& lane : lanes_) {
      write_binary(out, lane.effort);
      write_binary(out, lane.statistics);
    }
  }
  void load(CheckpointIn in) {
    read_binary(in, setups_);
    read_binary(in, seconds_);
    for (Lane& lane : lanes_) {
      read_binary(in, lane.effort);
      read_binary(in, lane.statistics);
    }
  }

 private:
  // Iterations since the last set-up: the fewest a solve took, and those beyond that, summed.
  struct Effort {
    long fewest = -1;
    long extra = 0;

    void count(int iterations) {
      if (fewest < 0 || iterations < fewest) fewest = iterations;
      extra += iterations - fewest;
    }
  };
  struct Lane {
    Effort effort;
    LinearStatistics statistics;
  };

  long price_;
  std::vector<Lane> lanes_;
  bool ready_ = false;
  double shift_ = 0;
  long setups_ = 0;
  double seconds_ = 0;
};

}  // namespace traceraft::linear
