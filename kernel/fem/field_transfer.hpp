// Nodal fields from one mesh of a surface to another.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::fem {

// Nodes of both meshes keep their values. A node of the new one alone has that of the old field
// where it lies inside an old tetrahedron, else that of the nearest point of the old Γ_h.
//
// Values off the surface are data, too: where they are replaced by others with the same trace, as
// an L² projection or interpolation from the surface does, the dissipation ∫ M |∇μ|² of the next
// step grows by a factor of hundreds, and steps shrink as much.
class FieldTransfer {
 public:
  // Spaces of one surface, the old one whole on this rank; neither is kept.
  FieldTransfer(const SurfaceSpace& from, const SurfaceSpace& to);

  Vec field(VecView nodal) const;
  // Both halves of a state vector; the first keeps ∫ exactly, up to roundoff, by a constant.
  Vec state(VecView y) const;

  int copied_nodes() const { return copied_; }  // of this rank

 private:
  // Row i: the old nodes that make the new value at node i.
  std::vector<int> begin_, node_;
  std::vector<double> weight_;
  Vec old_area_, new_area_;  // of each node
  double area_;
  std::shared_ptr<const Communicator> ranks_;
  int copied_ = 0;
};

}  // namespace traceraft::fem
