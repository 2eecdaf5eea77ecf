#include "backends/suitesparse/blas.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

#include "backends/openblas/dense_algebra.hpp"

namespace traceraft {
namespace {

std::ptrdiff_t threads() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

// Of matrices that OpenBLAS would share out.
TEST(Blas, HasNoThreadsOfItsOwn) {
  use_one_blas_thread();
  const std::ptrdiff_t before = threads();
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(400, 400), B = 2 * A;
  EXPECT_EQ(product(A, B), B);
  EXPECT_EQ(threads(), before);
  EXPECT_EQ(before, 1);
}

}  // namespace
}  // namespace traceraft
