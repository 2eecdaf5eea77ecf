// The main function of the test programs: they compute with the kernels of BLAS and the number of
// threads that the program uses.
#include <gtest/gtest.h>

#include "backends/posix/process.hpp"
#include "backends/suitesparse/blas.hpp"

int main(int argc, char** argv) {
  traceraft::posix::restart_with_environment(traceraft::suitesparse::preferred_environment(), argv);
  traceraft::suitesparse::use_one_blas_thread();
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
