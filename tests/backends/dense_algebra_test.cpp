#include "backends/openblas/dense_algebra.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

using Eigen::MatrixXd;

MatrixXd random_matrix(int rows, int columns, std::uint64_t seed) {
  return testing::random_vector(rows * columns, seed).reshaped(rows, columns);
}

TEST(DenseAlgebra, AgreesWithEigen) {
  const MatrixXd A = random_matrix(7, 5, 1), B = random_matrix(5, 3, 2), C = random_matrix(7, 4, 3);
  EXPECT_TRUE(openblas::product(A, B).isApprox(A * B, 1e-13));
  EXPECT_TRUE(openblas::transposed_product(A, C).isApprox(A.transpose() * C, 1e-13));
  const MatrixXd half = (A.transpose() * A).triangularView<Eigen::Lower>();
  EXPECT_TRUE(openblas::gram(A).isApprox(half, 1e-13));
}

TEST(DenseAlgebra, DividesByTheUpperTriangleAlone) {
  const MatrixXd R = random_matrix(5, 5, 4) + 5 * MatrixXd::Identity(5, 5);
  const MatrixXd X = random_matrix(7, 5, 5);
  const MatrixXd upper = R.triangularView<Eigen::Upper>();
  EXPECT_TRUE((openblas::divided_by_upper(X, R) * upper).isApprox(X, 1e-13));
}

TEST(DenseAlgebra, FactorisesTheLowerHalf) {
  const MatrixXd half = openblas::gram(random_matrix(9, 6, 7)), X = random_matrix(6, 2, 8);
  const MatrixXd whole = half.selfadjointView<Eigen::Lower>();
  const MatrixXd L = openblas::cholesky_factor(half);
  const MatrixXd lower = L.triangularView<Eigen::Lower>();
  EXPECT_TRUE((lower * lower.transpose()).isApprox(whole, 1e-13));
  EXPECT_TRUE(openblas::divided_by_factors(L, whole * X).isApprox(X, 1e-10));
  EXPECT_THROW(openblas::cholesky_factor(-half), std::runtime_error);
}

TEST(DenseAlgebra, FindsEigenvectorsFromTheLowerHalf) {
  const MatrixXd half = openblas::gram(random_matrix(9, 6, 6));
  const MatrixXd whole = half.selfadjointView<Eigen::Lower>();
  const openblas::SymmetricEigen eigen = openblas::symmetric_eigen(half);
  EXPECT_TRUE((whole * eigen.vectors).isApprox(eigen.vectors * eigen.values.asDiagonal(), 1e-12));
  EXPECT_TRUE((eigen.vectors.transpose() * eigen.vectors).isIdentity(1e-12));
  EXPECT_TRUE(std::is_sorted(eigen.values.begin(), eigen.values.end()));
}

TEST(DenseAlgebra, TakesMatricesWithoutColumns) {
  EXPECT_EQ(openblas::product(MatrixXd(4, 0), MatrixXd(0, 3)), MatrixXd::Zero(4, 3));
  EXPECT_EQ(openblas::transposed_product(MatrixXd(4, 0), MatrixXd::Ones(4, 3)).rows(), 0);
  EXPECT_EQ(openblas::gram(MatrixXd(4, 0)).size(), 0);
  EXPECT_EQ(openblas::symmetric_eigen(MatrixXd(0, 0)).values.size(), 0);
}

TEST(DenseAlgebra, RefusesWhatIsNotFinite) {
  MatrixXd A = MatrixXd::Identity(3, 3);
  A(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(openblas::symmetric_eigen(A), std::runtime_error);
}

}  // namespace
}  // namespace traceraft
