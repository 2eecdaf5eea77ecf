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

// Fine in a band around the equator.
std::shared_ptr<const fem::SurfaceSpace> graded() {
  const geometry::LevelSetPtr surface = geometry::make_surface("sphere");
  const mesh::RefinementForest forest(*surface, {48, 2}, 0);
  const mesh::ActiveMesh coarse = mesh::build_active_mesh(*surface, forest);
  std::vector<int> wanted;
  for (const mesh::ActiveTet& tet : coarse.tets)
    wanted.push_back(std::fabs(coarse.position(tet.node[0]).z()) < 0.1 ? 6 : 0);
  return std::make_shared<fem::SurfaceSpace>(
      surface, mesh::build_active_mesh(*surface, forest.refined(*surface, wanted)),
      std::make_shared<ThreadTeam>(1), std::make_shared<SerialCommunicator>());
}

std::size_t numbers_of(const suitesparse::SupernodalStructure& structure) {
  std::size_t count = 0;
  for (const suitesparse::Supernode& node : structure.supernodes)
    count += static_cast<std::size_t>(node.rows) * node.columns;
  return count;
}

// Minimum degree on a graded mesh; where its factor would be long, METIS.
TEST(Multifrontal, OrdersQuicklyWhereTheFactorIsShort) {
  using suitesparse::Ordering;
  const auto whole = make_space(96), band = graded();
  const auto dissected = suitesparse::analyse(*whole->pattern);
  EXPECT_EQ(suitesparse::analyse(*whole->pattern, Ordering::quick)->permutation,
            dissected->permutation);
  const auto best = suitesparse::analyse(*band->pattern);
  const auto quick = suitesparse::analyse(*band->pattern, Ordering::quick);
  EXPECT_NE(quick->permutation, best->permutation);
  EXPECT_LT(numbers_of(*quick), 1.3 * numbers_of(*best));
  const fem::CsrMatrix A = fem::combine(0.01, band->stabilised_mass, 1, band->stiffness);
  const Eigen::MatrixXd expected = permuted(*quick, A).llt().matrixL();
  EXPECT_LT((factor(*quick, A) - expected).norm(), 1e-5 * expected.norm());
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
