// Real spherical harmonics, orthonormal in L² of the unit sphere:
//   Y_lm(θ, φ) = P̃_lm(cos θ) {1/√2π, cos mφ/√π, sin mφ/√π},   ∫_{-1}^{1} P̃_lm² = 1.
#pragma once

#include "kernel/core/types.hpp"

namespace traceraft::flow {

// P̃_lm at x = cos θ for l = m … degree: entry l - m. By the recurrence in l, which is stable.
Vec legendre(int degree, int m, double x);

}  // namespace traceraft::flow
