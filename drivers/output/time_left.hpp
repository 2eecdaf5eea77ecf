// How long a run still takes.
#pragma once

#include <vector>

namespace traceraft::output {

// From the last third of its steps, since a single one says little: steps are short while a raft
// vanishes. They grow in proportion to time while rafts coarsen, or stay as they are; what is
// sooner counts.
class TimeLeft {
 public:
  explicit TimeLeft(double end) : end_(end) {}  // of the simulated time

  // After a step: the simulated time, and the seconds since the run began.
  void note(double t, double seconds);
  double seconds() const;  // 0 while that is unknown
  // Between what and what the truth lies in nine of ten moments of runs that coarsen. Both are 0
  // while that is unknown.
  struct Range {
    double low = 0, high = 0;
  };
  Range range() const;
  double share() const { return share_; }  // of the run that is done; it never falls

 private:
  struct Mark {
    double t, seconds;
  };
  double end_, share_ = 0;
  std::vector<Mark> marks_;
};

}  // namespace traceraft::output
