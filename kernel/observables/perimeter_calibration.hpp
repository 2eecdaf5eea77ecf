// p0: what makes the diffuse perimeter p0 ∫ ε|∇_Γ c|² a length on a given mesh.
#pragma once

#include <optional>

#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft {

struct PerimeterCalibration {
  double interface_energy;  // ∫ ε|∇c|² per unit length of phase boundary on this mesh: 1/p0
  double resolved;          // the same over its exact value, √(2ρ)(b − a)³/6
};

// Two equal halves of the unit sphere, relaxed to equilibrium with the energy of `model` on this
// mesh; `axis` points from one half to the other. Nothing where there is no boundary to speak of.
std::optional<Vec> relaxed_boundary(const SurfaceSpace& sphere, const CahnHilliardModel& model,
                                    const Point& axis);

// ∫ ε|∇c|² per unit length of that boundary.
double relaxed_interface_energy(const SurfaceSpace& sphere, const CahnHilliardModel& model,
                                const Point& axis);

// The mean over four axes: makes the perimeter of two equal halves 2π on average. What one boundary
// has depends on how it lies in the mesh, within some 3 % at h/ε = 2. Where less than half of the
// energy is left (ε too large for two phases, or far too coarse), p0 is the exact value.
PerimeterCalibration calibrate_perimeter(const SurfaceSpace& sphere,
                                         const CahnHilliardModel& model);

}  // namespace traceraft
