// Cholesky factors for preconditioners: CHOLMOD analyses, the numbers are computed in single
// precision and kept in 16 bits.
#pragma once

#include "backends/suitesparse/supernodal_structure.hpp"
#include "kernel/linear/krylov.hpp"

namespace traceraft::suitesparse {

// All solvers that the factory makes share the analysis of `pattern`, which the first one makes.
// They can factorise at the same time.
linear::SpdSolverFactory supernodal_factory(fem::PatternPtr pattern,
                                            Ordering ordering = Ordering::dissection);

}  // namespace traceraft::suitesparse
