// The energy of a discrete state, freed of most of what the mesh adds to it.
#pragma once

#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft {

// ‖G − ∇_Γ c_h‖² in L²(Γ_h) with the recovered gradient G, the projection of ∇_Γ c_h on continuous
// functions: it estimates the square of the error of the gradient (Zienkiewicz, Zhu, Int. J. Numer.
// Meth. Eng. 24 (1987)).
double gradient_error_squared(const SurfaceSpace& space, ConstVec c);

// ∫ f0 + ½ ε² |∇_Γ c|² of c_h minus ½ ε² times that. P1 functions have too steep boundaries, in
// sum: at h/ε = 2 their energy is 1 to 3 % too high, depending on how a boundary lies in the mesh;
// this one is less than 0.5 % too low.
double recovered_energy(const CahnHilliard& problem, ConstVec c);

}  // namespace traceraft
