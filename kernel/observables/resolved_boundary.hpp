// p0: what makes the diffuse perimeter p0 ∫ ε|∇_Γ c|² a length on a given mesh.
#pragma once

#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::observables {

struct ResolvedBoundary {
  double interface_energy;  // ∫ ε|∇c|² per unit length of phase boundary on this mesh: 1/p0
  double resolved;          // the same over its exact value, √(2ρ)(b − a)³/6
};

// From a table of straight boundaries in equilibrium over h/ε, with h in units of R: the mean over
// how they may lie in the mesh. One of them is off by 0.3 % (averaged), 0.9 % (consistent) or 3 %
// (nodal) at h/ε = 2.6. A great circle of the unit sphere has 4 (ε/R)² less than a straight line.
// Tests measure it again.
ResolvedBoundary resolved_boundary(const problem::CahnHilliardModel& model, double h);

}  // namespace traceraft::observables
