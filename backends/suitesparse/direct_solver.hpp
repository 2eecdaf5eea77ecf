// Linear solver: LU factors of the whole system, made afresh for every Jacobian.
#pragma once

#include <string>

#include "backends/suitesparse/sparse_lu.hpp"
#include "kernel/linear/linear_solver.hpp"

namespace traceraft::suitesparse {

linear::LinearSolverPtr make_direct_solver(const std::string& name, const SparseLuFactory& make_lu,
                                           const fem::PatternPtr& pattern, int lanes);

}  // namespace traceraft::suitesparse
