// The BLAS behind the factorisations: OpenBLAS, always with one thread. Supernodes are small, and
// the second core is better used by a second factorisation.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace traceraft::suitesparse {

// Once per process. OpenBLAS starts a thread for each processor when it is loaded, which looks for
// work for 0.1 s of its processor: the sooner this ends them the better.
void use_one_blas_thread();

// CHOLMOD starts OpenMP threads for loops that are too short for them (a factorisation at n = 128:
// 135 ms with, 105 ms without). From now on none are started by the thread that calls this.
void use_one_openmp_thread();

// E.g. "OpenBLAS 0.3.21 (SkylakeX)".
std::string blas_description();

// The variable that the environment should hold before OpenBLAS is loaded: OPENBLAS_CORETYPE.
// OpenBLAS picks its kernels by processor model and falls back to those of the 1990s (Prescott) on
// models newer than itself, which makes factorisations about twice as slow. The variable is set to
// what the processor can do in that case only: loading all libraries once more takes 0.13 s.
std::vector<std::pair<std::string, std::string>> preferred_environment();

}  // namespace traceraft::suitesparse
