// The numerical half of a sparse Cholesky factorisation, in single precision.
#pragma once

#include <functional>
#include <vector>

#include "backends/suitesparse/supernodal_structure.hpp"

namespace traceraft::suitesparse {

// Takes the finished columns of a supernode: `columns` times `rows` numbers of L, `rows` apart, of
// which those above the diagonal mean nothing.
using KeepColumns = std::function<void(std::size_t supernode, const float* columns)>;

// Multifrontal factorisation of the matrix whose CSR values are given (Duff and Reid 1983; Liu,
// SIAM Review 34, 1992). A supernode is done with as soon as its columns are kept, so that no more
// than the columns of one supernode and the updates that wait for their parents are held.
//
// The factor is for preconditioners. Single precision cannot tell a tiny eigenvalue from zero, and
// where steps are long the matrices have one: that of the constants. A pivot that is zero within
// roundoff is replaced by a small positive one. false if a pivot is more negative than that: the
// matrix is not positive definite.
bool factorise_multifrontal(const SupernodalStructure& structure, const std::vector<double>& values,
                            const KeepColumns& keep);

}  // namespace traceraft::suitesparse
