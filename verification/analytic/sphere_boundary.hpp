// The equilibrium of two equal halves of the unit sphere, without any mesh of the surface.
#pragma once

#include <vector>

#include "kernel/physics/double_well.hpp"

namespace traceraft::analytic {

// c(φ), φ the latitude, solves ε² (c'' − tan φ c') = f0'(c) with c(0) = (a + b)/2 and c' = 0 at the
// pole: μ = 0 by symmetry. It differs from the flat tanh profile by O(ε²); for the default well its
// energy is that of a flat boundary times 1 − 4 ε² (π²/12 − 1/2) + O(ε⁴).
class SphereBoundary {
 public:
  // ε > 0, in radii. Throws std::runtime_error if Newton's method does not converge.
  SphereBoundary(const physics::DoubleWell& well, double epsilon);

  double profile(double latitude) const;     // in [−π/2, π/2], b at the north pole
  double energy() const { return energy_; }  // ∫ f0(c) + ½ ε² |∇c|², of the whole sphere
  double width() const { return width_; }    // ∫ (c − a)(b − c), of the whole sphere

 private:
  physics::DoubleWell well_;
  std::vector<double> c_;  // at the latitudes (i + ½) π/(2 size)
  double energy_ = 0, width_ = 0;
};

}  // namespace traceraft::analytic
