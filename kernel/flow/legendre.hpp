// Legendre functions.
#pragma once

#include "kernel/core/types.hpp"

namespace traceraft::flow {

// Associated ones that are orthonormal on [−1, 1]: P̃_lm(cos θ) for l = m … degree, and their
// derivatives by θ: entry l − m.
Vec legendre(int degree, int m, double theta);
Vec legendre_slopes(int degree, int m, double theta);  // not at a pole

// The velocity of the centroid of a cap of half angle α, the direction of ∫ x, in a flow of degree
// l, over that of the flow in its middle: 2 P_l'(cos α)/(l (l + 1)) for l = 1 … degree. Entry l; 0
// for l = 0.
Vec means_over_cap(double cosine, int degree);

}  // namespace traceraft::flow
