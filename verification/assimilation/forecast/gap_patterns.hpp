// The patterns as which a gap between a forecast and the measurements is sought.
#pragma once

#include "kernel/fem/sparse_view.hpp"
#include "kernel/fem/surface_space.hpp"
#include "kernel/physics/double_well.hpp"
#include "verification/assimilation/forecast/tangent_flow.hpp"

namespace traceraft::assimilation {

// Patterns of c that an error of the model may have: smooth shifts of the phase boundaries, and
// some smooth fields.
class GapPatterns {
 public:
  // Smooth: polynomials in x, y, z up to a degree, restricted to Γ. Serial spaces.
  GapPatterns(const fem::SurfaceSpace& space, int degree);
  // The patterns at a state c, nodes × patterns. Their sum of squares has a mean of 1.
  Columns at(const physics::DoubleWell& well, const Vec& c) const;

 private:
  double area_;
  fem::EigenMatrix mass_;
  Columns smooth_;  // nodes × patterns, orthogonal, with a mean square of 1
};

}  // namespace traceraft::assimilation
