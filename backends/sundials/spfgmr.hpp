// Flexible GMRES (SUNDIALS SPFGMR) as the kernel's Krylov method.
#pragma once

#include <memory>

#include "kernel/linear/krylov.hpp"

namespace traceraft::sundials {

// `size`: length of the vectors; restarts after 50 iterations.
std::unique_ptr<linear::KrylovMethod> make_spfgmr(int size);

}  // namespace traceraft::sundials
