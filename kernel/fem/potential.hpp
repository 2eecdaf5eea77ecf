// b(c)_i = ∫_Γ f0'(c_h) φ_i, its derivative, and ∫_Γ f0(c_h).
#pragma once

#include "kernel/fem/surface_space.hpp"
#include "kernel/physics/double_well.hpp"

namespace traceraft::fem {

enum class PotentialRule {
  averaged,    // √f0 averaged over each element (averaged_potential.hpp): b is a gradient
  consistent,  // degree-4 quadrature on every triangle: b is the gradient of the discrete energy
  nodal        // M f0'(c): the reference code's choice, not the gradient of any energy
};

// r += factor · b(c). `c` has ghosts.
void add_potential(const SurfaceSpace& space, const physics::DoubleWell& well, PotentialRule rule,
                   double factor, VecView c, VecRef r);

// matrix += factor · ∂b/∂c: ∫ f0''(c_h) φ_i φ_j, or M diag(f0''(c)) for the nodal rule.
void add_potential_tangent(const SurfaceSpace& space, const physics::DoubleWell& well,
                           PotentialRule rule, double factor, VecView c, CsrMatrix& matrix);

// r += factor · (∂b/∂c) v without assembling.
void add_potential_tangent_product(const SurfaceSpace& space, const physics::DoubleWell& well,
                                   PotentialRule rule, double factor, VecView c, VecView v,
                                   VecRef r);

// ∫_Γ f0(c_h) over this rank's triangles: of the averaged rule what b is the gradient of, else
// exact.
double potential_energy(const SurfaceSpace& space, const physics::DoubleWell& well,
                        PotentialRule rule, VecView c);

}  // namespace traceraft::fem
