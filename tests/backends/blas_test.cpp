#include "backends/suitesparse/blas.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>

#include "backends/openblas/dense_algebra.hpp"

namespace traceraft {
namespace {

std::ptrdiff_t threads() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

// The matrices are large enough to be shared out. In a process of its own, as MPI has threads.
TEST(BlasDeathTest, HasNoThreadsOfItsOwn) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto check = [] {
    const std::ptrdiff_t before = threads();
    const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(400, 400), B = 2 * A;
    const bool right = openblas::product(A, B) == B;
    std::fprintf(stderr, "%td and %td threads, the product is %s\n", before, threads(),
                 right ? "right" : "wrong");
    std::exit(0);
  };
  EXPECT_EXIT(check(), ::testing::ExitedWithCode(0), "1 and 1 threads, the product is right");
}

}  // namespace
}  // namespace traceraft
