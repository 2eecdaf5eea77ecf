// Tests that run on all ranks of mpirun at the same time; one of them speaks, all of them can fail.
#include <gtest/gtest.h>

#include "backends/posix/process.hpp"
#include "backends/ranks.hpp"
#include "backends/suitesparse/blas.hpp"

int main(int argc, char** argv) {
  traceraft::posix::restart_with_environment(traceraft::suitesparse::preferred_environment(), argv);
  traceraft::suitesparse::use_one_blas_thread();
  ::testing::InitGoogleTest(&argc, argv);
  const traceraft::backends::RankSession session;
  const auto ranks = traceraft::backends::world();
  if (!ranks->root()) {
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
  }
  const int failed = RUN_ALL_TESTS();
  return ranks->any(failed != 0) ? 1 : 0;
}
