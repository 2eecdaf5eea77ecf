// A fill-reducing METIS ordering of a sparsity pattern.
#pragma once

#include <vector>

#include "kernel/fem/csr.hpp"

namespace traceraft::suitesparse {

// Throws std::runtime_error if METIS cannot order it.
std::vector<int> metis_ordering(const fem::SparsityPattern& pattern);

}  // namespace traceraft::suitesparse
