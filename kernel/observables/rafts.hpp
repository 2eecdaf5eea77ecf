// Rafts: the connected components of {c > level} on Γ_h.
#pragma once

#include <memory>
#include <vector>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::observables {

struct Raft {
  double area;
  double perimeter;  // length of its boundary, the level curve
  Point centre;      // of area: below the surface, and for a ring in its hole
  double distance;   // from there to the nearest point of the raft
};

struct RaftReport {
  std::vector<Raft> rafts;      // largest first, equally large ones in the order of their nodes
  std::vector<int> of_point;    // of this rank's triangles: 1 is the first raft, 0 none
  double area = 0;              // of {c > level}
  double perimeter = 0;         // length of the level curve
  double c_min = 0, c_max = 0;  // on Γ_h, where nodal values mean nothing
};

// c_h is linear on every triangle of Γ_h, so {c > level} is a convex piece of each: areas and
// lengths are exact, and two triangles belong to one raft exactly if they share a vertex above the
// level. Coordinates, areas and lengths in units of R. Collective; every rank has the whole report.
class RaftFinder {
 public:
  explicit RaftFinder(std::shared_ptr<const fem::SurfaceSpace> space);
  RaftReport find(VecView c, double level) const;
  // The number of connected components of {c < level}.
  int regions_below(VecView c, double level) const;

 private:
  std::shared_ptr<const fem::SurfaceSpace> space_;
};

}  // namespace traceraft::observables
