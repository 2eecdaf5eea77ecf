// --linear-solver teko: Belos with block preconditioners of Teko, on any number of ranks.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "kernel/fem/csr.hpp"
#include "kernel/linear/linear_solver.hpp"

namespace traceraft::trilinos {

// preconditioner: two-solve, gauss-seidel, block-lu, or a name from the parameter file
// inverse: muelu, muelu-ilu, ifpack2, direct (on one rank), or a name from the parameter file
// method: fgmres, gmres, gcrodr, bicgstab
// parameters: "" or a Teuchos XML file with the sublists "Inverse Library" and "Belos"
using TekoOptions = std::map<std::string, std::string>;

// Throws InputError for a name or a file that is not known.
linear::LinearSolverFactory make_teko_solver(const fem::PatternPtr& pattern,
                                             const TekoOptions& options);

}  // namespace traceraft::trilinos
