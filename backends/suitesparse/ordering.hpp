// A fill-reducing METIS ordering of a sparsity pattern.
#pragma once

#include <vector>

#include "kernel/fem/csr.hpp"

namespace traceraft {

// Throws std::runtime_error if METIS cannot order it.
std::vector<int> metis_ordering(const SparsityPattern& pattern);

}  // namespace traceraft
