// K_M(c): the stiffness matrix weighted with the mobility. K_M = Σ_T I_T G_T, where
// I_T = max(0, ∫_T M(c_h)) and G_T = (∇_Γλ_i·∇_Γλ_j): each tetrahedron counts with its mean
// mobility, floored at zero.
#pragma once

#include <vector>

#include "kernel/fem/surface_space.hpp"
#include "kernel/physics/mobility.hpp"

namespace traceraft::fem {

// I_T by the edge-midpoint rule on each triangle (exact for quadratic M). `c` has ghosts.
std::vector<double> mobility_integrals(const SurfaceSpace& space, const physics::Mobility& law,
                                       VecView c);

// The same with ∂I_T/∂c_i at the four nodes of each element (zero where floored).
std::vector<double> mobility_integrals(const SurfaceSpace& space, const physics::Mobility& law,
                                       VecView c, std::vector<std::array<double, 4>>& gradient);

// Σ_T I_T G_T. Rows sum to zero exactly, so 1ᵀ K_M = 0 conserves mass to roundoff.
void assemble_mobility_stiffness(const SurfaceSpace& space, const std::vector<double>& integral,
                                 CsrMatrix& matrix);

// r += Σ_T I_T G_T u without assembling; each edge's flux is added once and subtracted once.
void add_mobility_flux(const SurfaceSpace& space, const std::vector<double>& integral, VecView u,
                       VecRef r);

// How the integrals change along a direction of c (with ghosts).
std::vector<double> mobility_change(const SurfaceSpace& space,
                                    const std::vector<std::array<double, 4>>& gradient,
                                    VecView direction);

// matrix += factor · ∂(Σ_T I_T G_T μ)/∂c.
void add_mobility_derivative(const SurfaceSpace& space, double factor, VecView mu,
                             const std::vector<std::array<double, 4>>& gradient, CsrMatrix& matrix);

}  // namespace traceraft::fem
