// K_M(c): the stiffness matrix weighted with the mobility.
#pragma once

#include <vector>

#include "kernel/fem/surface_space.hpp"
#include "kernel/physics/mobility.hpp"

namespace traceraft {

// Mean of M(c_h) over Γ_h in each tetrahedron, floored at zero: m̄_T = max(0, ∫_T M(c_h) / |Γ_T|),
// by the edge-midpoint rule on each triangle (exact for quadratic M). `c` has ghosts.
void mean_mobility(const SurfaceSpace& space, const Mobility& law, ConstVec c,
                   std::vector<double>& mean);

// The same with ∂m̄_T/∂c_i at the four nodes (zero where floored).
void mean_mobility(const SurfaceSpace& space, const Mobility& law, ConstVec c,
                   std::vector<double>& mean, std::vector<std::array<double, 4>>& gradient);

// K_M = Σ_T m̄_T K_T. Rows sum to zero exactly, so 1ᵀ K_M = 0 conserves mass to roundoff.
void assemble_mobility_stiffness(const SurfaceSpace& space, const std::vector<double>& mean,
                                 CsrMatrix& matrix);

// r += Σ_T m̄_T K_T u without assembling; each edge's flux is added once and subtracted once.
void add_mobility_flux(const SurfaceSpace& space, const std::vector<double>& mean, ConstVec u,
                       VecRef r);

}  // namespace traceraft
