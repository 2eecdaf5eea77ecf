#include "backends/suitesparse/multifrontal.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tests/support/dense.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

using testing::make_space;

// L as a dense matrix; empty if the matrix is not positive definite.
Eigen::MatrixXd factor(const suitesparse::SupernodalStructure& structure, const fem::CsrMatrix& A) {
  const auto n = static_cast<Eigen::Index>(structure.permutation.size());
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
  const bool ok = suitesparse::factorise_multifrontal(
      structure, A.values, [&](std::size_t s, const float* columns) {
        const suitesparse::Supernode& node = structure.supernodes[s];
        for (int j = 0; j < node.columns; ++j)
          for (int i = j; i < node.rows; ++i)
            L(structure.rows[node.row_begin + i], node.first_column + j) =
                columns[j * node.rows + i];
      });
  return ok ? L : Eigen::MatrixXd();
}

Eigen::MatrixXd permuted(const suitesparse::SupernodalStructure& structure,
                         const fem::CsrMatrix& A) {
  const Eigen::MatrixXd full = testing::dense(A);
  return full(structure.permutation, structure.permutation);
}

// Two surfaces that do not touch: the elimination tree has two roots.
std::shared_ptr<const fem::SurfaceSpace> two_spheres() {
  const auto phi = std::make_shared<geometry::FunctionLevelSet>([](const Point& x) {
    return std::min((x - Point(0, 0, 0.8)).norm(), (x + Point(0, 0, 0.8)).norm()) - 0.5;
  });
  return std::make_shared<fem::SurfaceSpace>(phi, 20, std::make_shared<ThreadTeam>(1),
                                             std::make_shared<SerialCommunicator>());
}

TEST(Multifrontal, IsTheCholeskyFactorInSinglePrecision) {
  for (const auto& space : {make_space(20), two_spheres()}) {
    const auto structure = suitesparse::analyse(*space->pattern);
    for (const double share : {1.0, 1e-3}) {
      const fem::CsrMatrix A = fem::combine(share, space->stabilised_mass, 1, space->stiffness);
      const Eigen::MatrixXd expected = permuted(*structure, A).llt().matrixL();
      const Eigen::MatrixXd L = factor(*structure, A);
      ASSERT_EQ(L.rows(), expected.rows());
      EXPECT_LT((L - expected).norm(), 1e-5 * expected.norm()) << share;
    }
  }
}

// Where supernodes are wide, their columns are in several blocks and BLAS multiplies.
TEST(Multifrontal, IsTheFactorWhereSupernodesAreWide) {
  const auto space = make_space(40);
  const auto structure = suitesparse::analyse(*space->pattern);
  int widest = 0;
  for (const suitesparse::Supernode& node : structure->supernodes)
    widest = std::max(widest, node.columns);
  EXPECT_GT(widest, 96);
  const fem::CsrMatrix A = fem::combine(0.01, space->stabilised_mass, 1, space->stiffness);
  const Eigen::MatrixXd L = factor(*structure, A);
  const Eigen::MatrixXd expected = permuted(*structure, A);
  const Vec x = testing::random_vector(expected.rows(), 5);
  const Vec image = L * (L.transpose() * x);
  EXPECT_LT((image - expected * x).norm(), 1e-5 * (expected * x).norm());
}

// A pivot is as small as roundoff where a matrix is singular: the factor is of one that is not.
TEST(Multifrontal, ReplacesPivotsThatAreZeroWithinRoundoff) {
  const auto space = make_space(12);
  const auto structure = suitesparse::analyse(*space->pattern);
  const fem::CsrMatrix& A = space->stiffness;
  const Eigen::MatrixXd expected = permuted(*structure, A), L = factor(*structure, A);
  ASSERT_EQ(L.rows(), expected.rows());
  EXPECT_TRUE(L.allFinite());
  EXPECT_LT((L * L.transpose() - expected).norm(), 1e-5 * expected.norm());
}

// The unit matrix but for one pair of nodes, whose second pivot is 1 - 1 * 1, or below by roundoff.
TEST(Multifrontal, GivesAVanishingPivotItsLeastValue) {
  const auto space = make_space(8);
  const fem::SparsityPattern& pattern = *space->pattern;
  const auto structure = suitesparse::analyse(pattern);
  for (const double coupling : {1.0, 1.00002}) {
    fem::CsrMatrix A(space->pattern);
    for (const int k : pattern.diagonal) A.values[k] = 1;
    A.values[pattern.low_high[0]] = A.values[pattern.high_low[0]] = coupling;
    const Eigen::MatrixXd L = factor(*structure, A);
    ASSERT_EQ(L.rows(), pattern.rows()) << coupling;
    EXPECT_TRUE(L.allFinite());
    EXPECT_NEAR(L.diagonal().minCoeff(), 1e-3, 1e-6);
  }
}

TEST(Multifrontal, RefusesWhatIsNotPositiveDefinite) {
  const auto space = make_space(12);
  const auto structure = suitesparse::analyse(*space->pattern);
  // Its smallest eigenvalue is near -1.
  EXPECT_EQ(
      factor(*structure, fem::combine(1, space->stiffness, -1, space->stabilised_mass)).size(), 0);
  fem::CsrMatrix broken = space->stabilised_mass;
  for (const double value :
       {std::nan(""), HUGE_VAL, 1e39}) {  // the last is beyond single precision
    broken.values[space->pattern->diagonal[7]] = value;
    EXPECT_EQ(factor(*structure, broken).size(), 0) << value;
  }
}

}  // namespace
}  // namespace traceraft
