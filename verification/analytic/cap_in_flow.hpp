// A raft that is a spherical cap in a fluid membrane, without any mesh: what its line tension and
// Brownian motion do to it.
#pragma once

#include "kernel/flow/fluid_membrane.hpp"

namespace traceraft::analytic {

// The rate at which a boundary at angle + δ cos mφ becomes round by line tension, m ≥ 2, in D/R²:
//   γ_m = A (ε/6√2) (2π m²(m² − 1)/sin³α) Σ_{l ≥ m} P̃_lm(cos α)²/friction(l).
// The boundary is sharp.
double relaxation_rate(const flow::FluidMembrane& membrane, double epsilon, double angle, int m);

// The diffusion coefficient of the centre of a cap with a boundary of width ε, in D, where the flow
// has the degrees up to `degree`.
double centre_diffusion(const flow::FluidMembrane& membrane, double epsilon, double angle,
                        int degree);

}  // namespace traceraft::analytic
