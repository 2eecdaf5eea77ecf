#include "verification/assimilation/filter/innovation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "backends/openblas/dense_algebra.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::assimilation {
namespace {

using Eigen::MatrixXd;

constexpr int kValues = 40, kState = 5, kGaps = 3;

Innovation make_innovation() {
  Innovation in{};
  in.directions =
      testing::random_vector(kValues * (kState + kGaps), 1).reshaped(kValues, kState + kGaps);
  in.state_directions = kState;
  in.gram = openblas::gram(in.directions);
  in.values = testing::random_vector(kValues, 2);
  return in;
}

MatrixXd dense_covariance(const Innovation& in, double gap_size) {
  MatrixXd scaled = in.directions;
  scaled.rightCols(kGaps) *= gap_size;
  return MatrixXd::Identity(kValues, kValues) + scaled * scaled.transpose();
}

double dense_deviance(const Innovation& in, double gap_size) {
  const MatrixXd S = dense_covariance(in, gap_size);
  return in.values.dot(S.ldlt().solve(in.values)) + std::log(S.determinant());
}

TEST(InnovationCovariance, IsThatOfTheDenseMatrix) {
  const Innovation in = make_innovation();
  for (const double size : {0.0, 0.3, 2.0}) {
    const InnovationCovariance weight(in, size);
    const MatrixXd S = dense_covariance(in, size);
    EXPECT_TRUE(weight.solve(in.values).isApprox(S.ldlt().solve(in.values), 1e-10));
    EXPECT_NEAR(weight.log_determinant(), std::log(S.determinant()), 1e-9);
  }
}

// Kalman's formulas in their dense form: K = P Gᵀ S⁻¹, P⁺ = P − P Gᵀ S⁻¹ G P with P = L D² Lᵀ.
TEST(InnovationCovariance, CorrectsLikeTheDenseFilter) {
  const Innovation in = make_innovation();
  const double size = 0.4;
  const InnovationCovariance weight(in, size);
  const Columns L = testing::random_vector(7 * (kState + kGaps), 3).reshaped(7, kState + kGaps);
  Vec scale = Vec::Ones(kState + kGaps);
  scale.tail(kGaps).setConstant(size);
  const MatrixXd D = scale.asDiagonal(), cross = L * D * D * in.directions.transpose();
  const MatrixXd S = dense_covariance(in, size);
  EXPECT_TRUE(
      (L * weight.amplitudes(in.values)).isApprox(cross * S.ldlt().solve(in.values), 1e-10));
  const Columns root = weight.posterior_root(L);
  const MatrixXd left = L * D * D * L.transpose() - cross * S.ldlt().solve(cross.transpose());
  EXPECT_TRUE((root * root.transpose()).isApprox(left, 1e-10));
}

TEST(MostProbableError, HasTheLeastDeviance) {
  Innovation in = make_innovation();
  for (const double size : {0.0, 0.07}) {
    in.values = size * 40 * in.directions.rightCols(kGaps).rowwise().sum();
    const double best = most_probable_error(in);
    for (const double other : {0.0, 0.005, 0.02, 0.07, 0.15, 0.25})
      EXPECT_LE(dense_deviance(in, best), dense_deviance(in, other) + 1e-9) << other;
    EXPECT_EQ(best > 0, size > 0);
  }
}

// All that patterns of any size could explain is explained by very large ones.
TEST(ExplainedParts, AreThoseOfAProjection) {
  Innovation in = make_innovation();
  const MatrixXd P = in.directions.rightCols(kGaps);
  const MatrixXd weighted = dense_covariance(in, 0).ldlt().solve(P);
  const Vec load = weighted.transpose() * in.values;
  const double all = load.dot((P.transpose() * weighted).ldlt().solve(load));
  EXPECT_NEAR(explained_parts(in, 1e4, in.values).squaredNorm(), all, 1e-6 * all);
  EXPECT_LT(explained_parts(in, 0.1, in.values).squaredNorm(), all);
}

TEST(RootMeanSquare, CountsValues) {
  std::vector<Innovation> three(3, make_innovation());
  const auto squares = [](const Innovation& in) { return in.values.squaredNorm(); };
  EXPECT_EQ(root_mean_square(three, true, squares), 0);
  const double all = root_mean_square(three, false, squares);
  EXPECT_NEAR(all, std::sqrt(three[0].values.squaredNorm() / kValues), 1e-14);
  three[1].held_out = true;
  three[1].values *= 2;
  EXPECT_NEAR(root_mean_square(three, false, squares), all, 1e-14);
  EXPECT_NEAR(root_mean_square(three, true, squares), 2 * all, 1e-14);
}

}  // namespace
}  // namespace traceraft::assimilation
