// The BLAS behind the factorisations: OpenBLAS, always with one thread. Supernodes are small, and
// the second core is better used by a second factorisation.
#pragma once

#include <string>

namespace traceraft {

void use_one_blas_thread();

// E.g. "OpenBLAS 0.3.21 (SkylakeX)".
std::string blas_description();

// OpenBLAS picks its kernels by processor model when it is loaded and falls back to 1990s ones
// (Prescott) on models newer than itself, which makes factorisations about twice as slow. Returns
// the value of OPENBLAS_CORETYPE that fits what this processor can do, or "" if nothing is to gain.
std::string better_blas_core();

}  // namespace traceraft
