// CHOLMOD's settings and memory, of one thread at a time.
#pragma once

#include <suitesparse/cholmod.h>

#include "kernel/fem/csr.hpp"

namespace traceraft::suitesparse {

struct CholmodWorkspace {
  cholmod_common common;
  CholmodWorkspace() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.postorder = 1;
  }
  ~CholmodWorkspace() { cholmod_finish(&common); }
  CholmodWorkspace(const CholmodWorkspace&) = delete;
  CholmodWorkspace& operator=(const CholmodWorkspace&) = delete;
};

// The upper triangle of the pattern in compressed columns, without values: the lower triangle of
// the CSR rows, as the matrix is symmetric. To be freed by cholmod_free_sparse.
cholmod_sparse* upper_triangle(const fem::SparsityPattern& pattern, cholmod_common* common);

}  // namespace traceraft::suitesparse
