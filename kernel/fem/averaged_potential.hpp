// The potential whose square root is averaged over each cut element. With w = √(2 f0), which is
// quadratic for a double well, and the mean c̄ and the variance V of c_h on Γ_T:
//
//   E_T = ½ |Γ_T| (w̄² − η w'(c̄)² V),   w̄ = w(c̄) + ½ ξ w'' V.
//
// Why: the energy of a boundary is ½ Σ |Γ_T| (ε|∇c_h| − w̄)² + ε Σ |Γ_T| |∇c_h| w̄. With the mean
// itself, ξ = 1 and η = 0, the second sum is ε ∫ |∇W(c_h)| with W' = w, the exact line tension,
// wherever the boundary lies in the mesh (in one dimension: Speight and Ward, Nonlinearity 7,
// 1994). Quadrature of f0(c_h) misses that by ½ Var(w), and boundaries stick to the lattice. In two
// dimensions ∇c_h errs across a boundary too. That adds g ε² ∫ c''² s², with s² the second moment
// of the element along the normal, which V is as well: 2ξ + η = 2(1 + g). The values below cancel
// it on average over cuts of the Kuhn mesh, not in each direction: docs/decisions/0019.
//
// Larger elements, which lie in the phases, have ξ and η between these values and those of ∫
// f0(c_h) to second order, 1 and −1. There the variance must cost energy: with η > 0 a pure phase
// is unstable on elements longer than some 10 ε.
#pragma once

#include "kernel/fem/surface_space.hpp"
#include "kernel/physics/double_well.hpp"

namespace traceraft::fem::averaged_potential {

// ξ and η on elements of the smallest size.
inline constexpr double kVarianceInMean = 1.2;
inline constexpr double kSlopeTimesVariance = 0.4;
// Large values of c make E_T ∝ (c̄² + ξV)² − 4η c̄² V ≥ 4 (ξ − η) c̄² V.
static_assert(kSlopeTimesVariance < kVarianceInMean, "the energy has to be bounded from below");

// The meaning of potential.hpp; `c` and `v` have ghosts.
void add(const SurfaceSpace& space, const physics::DoubleWell& well, double factor, VecView c,
         VecRef r);
void add_tangent(const SurfaceSpace& space, const physics::DoubleWell& well, double factor,
                 VecView c, CsrMatrix& matrix);
void add_tangent_product(const SurfaceSpace& space, const physics::DoubleWell& well, double factor,
                         VecView c, VecView v, VecRef r);
double energy(const SurfaceSpace& space, const physics::DoubleWell& well, VecView c);

}  // namespace traceraft::fem::averaged_potential
