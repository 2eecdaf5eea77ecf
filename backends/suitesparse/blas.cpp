#include "backends/suitesparse/blas.hpp"

extern "C" {
void openblas_set_num_threads(int);
char* openblas_get_config();
char* openblas_get_corename();
}

namespace traceraft {
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
  openblas_set_num_threads(1);
}

std::string blas_description() {
  const std::string config = openblas_get_config();  // "OpenBLAS 0.3.21 NO_LAPACKE …"
  const std::size_t end = config.find(' ', config.find(' ') + 1);
  return config.substr(0, end) + " (" + openblas_get_corename() + ")";
}

std::vector<std::pair<std::string, std::string>> preferred_environment() {
  std::vector<std::pair<std::string, std::string>> environment = {{"OMP_THREAD_LIMIT", "1"},
                                                                  {"OPENBLAS_NUM_THREADS", "1"}};
  if (const std::string core = better_blas_core(); !core.empty())
    environment.emplace_back("OPENBLAS_CORETYPE", core);
  return environment;
}

}  // namespace traceraft
