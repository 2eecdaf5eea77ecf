// Supernodal Cholesky factorisation (CHOLMOD) with a METIS ordering computed once per pattern.
#pragma once

#include "kernel/linear/krylov.hpp"

namespace traceraft {

// All solvers that the factory makes share the ordering of `pattern`; each has a CHOLMOD workspace
// of its own, so they can factorise at the same time.
SpdSolverFactory cholmod_factory(PatternPtr pattern);

}  // namespace traceraft
