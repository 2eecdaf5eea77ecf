// Where and when a vesicle of synthetic measurements is looked at.
#pragma once

#include "kernel/geometry/level_set.hpp"
#include "verification/selection/blind/blind_request.hpp"

namespace traceraft::selection {

// How a vesicle lies in the mesh: turned about the z axis, which effects may know, and moved, by
// half of the mesh size h at most in each direction.
struct Placement {
  double angle;
  Point offset;

  Placement(std::uint64_t seed, double h);
  Point in_mesh(const Point& x) const;
};

struct BlindLooks {
  Placement placement;
  geometry::LevelSetPtr surface;
  std::vector<double> labels,  // times of the snapshots, in units of R²/D of the model
      times;                   // the same in units of R²/D of the truth

  explicit BlindLooks(const BlindRequest& request);
  // Unit vectors, uniform over the sphere.
  static std::vector<Point> directions(const BlindRequest& request, int snapshot);
};

}  // namespace traceraft::selection
