// --linear-solver direct: sparse LU of the whole block system (UMFPACK).
#pragma once

#include "kernel/linear/linear_solver.hpp"

namespace traceraft {

// Factorises for every J, each lane on its own. With μ = √σ ν the system is arranged as
//   [ B     −√σ M̃ ] [δc]   [ −b₂    ]
//   [ √σ M̃   A    ] [δν] = [ b₁/√σ ]
// which is quasi-definite for the stabilised tangent: any symmetric pivot order is stable, so the
// METIS order of the n×n pattern, expanded to (c, μ) pairs, can be kept.
LinearSolverPtr make_direct_solver(const PatternPtr& pattern, int lanes);

}  // namespace traceraft
