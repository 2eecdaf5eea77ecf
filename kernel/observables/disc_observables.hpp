// A vesicle of discs is observed like a concentration.
#pragma once

#include "kernel/discs/disc_system.hpp"
#include "kernel/observables/observables.hpp"

namespace traceraft::observables {

Observables observe(const discs::DiscSystem& system, const discs::DiscState& state);
// Without the points of any mesh.
RaftReport raft_report(const discs::DiscSystem& system, const discs::DiscState& state);

// The concentration that discs stand for, with the profiles of flat boundaries.
class DiscField {
 public:
  DiscField(const discs::DiscSystem& system, const discs::DiscState& state);

  double concentration(const Point& direction) const;
  // The number of the raft around a point, as a RaftReport counts them; 0: none.
  int raft(const Point& direction) const;

 private:
  struct Cap {
    Point centre;
    double angle, inside;  // half angle, c inside
  };

  // To the nearest boundary, negative within a disc, and whose it is.
  std::pair<double, std::size_t> nearest(const Point& direction) const;

  std::vector<Cap> caps_;  // the largest first
  double background_, epsilon_;
  physics::DoubleWell well_;
};

}  // namespace traceraft::observables
