#include "backends/suitesparse/sparse_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <stdexcept>

namespace traceraft {
namespace {

// The Laplacian of a grid of k × k points plus `shift`: eigenvalues 4 − 2 cos aπ/(k+1) − 2 cos
// bπ/(k+1).
Eigen::SparseMatrix<double> grid(int k, double shift) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](int a, int b) {
    entries.emplace_back(a, b, -1.0);
    entries.emplace_back(b, a, -1.0);
  };
  for (int i = 0; i < k; ++i)
    for (int j = 0; j < k; ++j) {
      entries.emplace_back(i * k + j, i * k + j, 4 + shift);
      if (i + 1 < k) couple(i * k + j, (i + 1) * k + j);
      if (j + 1 < k) couple(i * k + j, i * k + j + 1);
    }
  Eigen::SparseMatrix<double> A(k * k, k * k);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

double ln_determinant(int k, double shift) {
  double sum = 0;
  for (int a = 1; a <= k; ++a)
    for (int b = 1; b <= k; ++b)
      sum +=
          std::log(4 + shift - 2 * std::cos(a * M_PI / (k + 1)) - 2 * std::cos(b * M_PI / (k + 1)));
  return sum;
}

TEST(SparseCholesky, SolvesAndKnowsDeterminants) {
  constexpr int kSide = 40;
  suitesparse::SparseCholesky factors;
  for (const double shift : {0.0, 0.5}) {  // the second with the ordering of the first
    const Eigen::SparseMatrix<double> A = grid(kSide, shift);
    factors.factorise(A);
    EXPECT_NEAR(factors.log_determinant(), ln_determinant(kSide, shift), 1e-9);
    const Eigen::MatrixXd X = Eigen::MatrixXd::Random(kSide * kSide, 7);
    EXPECT_LT((factors.solve(A * X) - X).norm(), 1e-10 * X.norm());
  }
  const suitesparse::SparseCholesky moved = std::move(factors);
  EXPECT_NEAR(moved.log_determinant(), ln_determinant(kSide, 0.5), 1e-9);
}

TEST(SparseCholesky, CorrelatesAsTheInverse) {
  constexpr int kSide = 9;
  const Eigen::SparseMatrix<double> A = grid(kSide, 0.1);
  const auto one = Eigen::MatrixXd::Identity(kSide * kSide, kSide * kSide);
  const Eigen::MatrixXd X = suitesparse::SparseCholesky(A).correlated(one);
  EXPECT_LT((A * (X * X.transpose()) - one).norm(), 1e-12 * one.norm());
}

TEST(SparseCholesky, WhitensAndColours) {
  constexpr int kSide = 30;
  const Eigen::SparseMatrix<double> A = grid(kSide, 0.1);
  const suitesparse::SparseCholesky factors(A);
  const auto one = Eigen::MatrixXd::Identity(kSide * kSide, kSide * kSide);
  const Eigen::MatrixXd root = factors.coloured(one);
  EXPECT_LT((root * root.transpose() - A).norm(), 1e-12 * A.norm());
  EXPECT_LT((factors.whitened(root) - one).norm(), 1e-12 * one.norm());
}

TEST(SparseCholesky, RefusesWhatIsNotPositiveDefinite) {
  suitesparse::SparseCholesky factors;
  EXPECT_THROW(factors.factorise(grid(10, -1)), std::runtime_error);
  factors.factorise(grid(10, 1));  // and goes on
  EXPECT_NEAR(factors.log_determinant(), ln_determinant(10, 1), 1e-10);
}

}  // namespace
}  // namespace traceraft
