// Loops over factors are compiled for the processor at hand, and run without subnormal numbers.
#pragma once

// Compiled for several instruction sets; the loader picks the best one for the processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TRACERAFT_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TRACERAFT_CLONES
#endif

namespace traceraft::suitesparse {

// Far from the diagonal a factor decays to numbers that single precision holds as subnormals only,
// and arithmetic on those is a hundred times slower. While this lives they count as zero.
class FlushSubnormals {
 public:
#if defined(__SSE__)
  FlushSubnormals() : before_(__builtin_ia32_stmxcsr()) {
    __builtin_ia32_ldmxcsr(before_ | 0x8040);
  }
  ~FlushSubnormals() {
    __builtin_ia32_ldmxcsr(before_);
  }

 private:
  unsigned before_;
#endif
};

}  // namespace traceraft::suitesparse
