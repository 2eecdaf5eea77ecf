#include "backends/suitesparse/blas.hpp"

#include <mutex>

extern "C" {
void openblas_set_num_threads(int);
char* openblas_get_config();
char* openblas_get_corename();
int blas_thread_shutdown_() __attribute__((weak));  // unless OpenBLAS is built without threads
// A function of OpenMP, which is there if CHOLMOD was built with it.
void omp_set_max_active_levels(int) __attribute__((weak));
}

namespace traceraft::suitesparse {
namespace {

// The best kernels for this processor if OpenBLAS did not recognise it; "" if it did.
std::string better_blas_core() {
#if defined(__x86_64__) || defined(__i386__)
  const std::string core = openblas_get_corename();
  if (core != "Prescott" && core != "Core2" && core != "Generic") return "";
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return "";
}

}  // namespace

void use_one_blas_thread() {
  static std::once_flag done;
  std::call_once(done, [] {
    openblas_set_num_threads(1);  // would start threads again later
    if (blas_thread_shutdown_) blas_thread_shutdown_();
  });
}

void use_one_openmp_thread() {
  if (omp_set_max_active_levels) omp_set_max_active_levels(0);
}

std::string blas_description() {
  const std::string config = openblas_get_config();  // "OpenBLAS 0.3.21 NO_LAPACKE …"
  const std::size_t end = config.find(' ', config.find(' ') + 1);
  return config.substr(0, end) + " (" + openblas_get_corename() + ")";
}

std::vector<std::pair<std::string, std::string>> preferred_environment() {
  const std::string core = better_blas_core();
  if (core.empty()) return {};
  return {{"OPENBLAS_CORETYPE", core}};
}

}  // namespace traceraft::suitesparse
