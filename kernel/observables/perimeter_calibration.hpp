// p0: what makes the diffuse perimeter p0 ∫ ε|∇_Γ c|² a length on a given mesh.
#pragma once

#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft {

struct PerimeterCalibration {
  double interface_energy;  // ∫ ε|∇c|² per unit length of phase boundary on this mesh: 1/p0
  double resolved;          // the same over its exact value, √(2ρ)(b − a)³/6
};

// Relaxes two equal halves of the unit sphere to equilibrium with the energy of `model` on this
// mesh and demands that the perimeter be exactly 2π. `sphere` must be the unit sphere.
PerimeterCalibration calibrate_perimeter(const SurfaceSpace& sphere,
                                         const CahnHilliardModel& model);

}  // namespace traceraft
