#include "verification/assimilation/filter/random_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "backends/openblas/dense_algebra.hpp"
#include "kernel/core/random.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::assimilation {
namespace {

using Eigen::MatrixXd;

constexpr int kValues = 40, kState = 5, kModes = 3;
constexpr double kVariance = 0.6;

// The state's directions have the random ones among them, as a filter has.
Innovation with_variance(double variance) {
  Innovation in{};
  const MatrixXd all =
      testing::random_vector(kValues * (kState + kModes), 1).reshaped(kValues, kState + kModes);
  in.random.push_back({kFirstParameter, variance, all.rightCols(kModes)});
  in.directions = all;
  in.directions.rightCols(kModes) *= std::sqrt(variance);
  in.state_directions = kState + kModes;
  in.gram = openblas::gram(in.directions);
  in.values = testing::random_vector(kValues, 2);
  return in;
}

double deviance(double variance) {
  const Innovation in = with_variance(variance);
  const InnovationCovariance weight(in, 0);
  return in.values.dot(weight.solve(in.values).col(0)) + weight.log_determinant();
}

TEST(VarianceScore, IsTheSlopeOfTheLikelihood) {
  for (const double variance : {0.0, kVariance}) {
    const Innovation in = with_variance(variance);
    const VarianceScore score =
        variance_score(InnovationCovariance(in, 0), in.random.front().values,
                       side_by_side(in.values, 2 * in.values));
    constexpr double kStep = 1e-5;
    const double slope =
        variance == 0 ? (4 * deviance(kStep) - deviance(2 * kStep) - 3 * deviance(0)) / (2 * kStep)
                      : (deviance(variance + kStep) - deviance(variance - kStep)) / (2 * kStep);
    EXPECT_NEAR(score.scores[0], -slope / 2, 1e-4 * std::fabs(slope)) << variance;
    // A square of twice the values is four times as large, the trace is not.
    const double trace = 2 * (score.scores[1] - 4 * score.scores[0]) / 3;
    EXPECT_GT(trace, 0);
  }
}

Columns normal(Eigen::Index rows, Eigen::Index columns, std::uint64_t stream) {
  Columns X(rows, columns);
  for (Eigen::Index i = 0; i < X.size(); ++i)
    X.data()[i] = normal_random(1, stream, static_cast<std::uint64_t>(i));
  return X;
}

// By draws of values that have the covariance.
TEST(VarianceScore, HasTheMeanNothingAndItsInformationAsVariance) {
  const Innovation in = with_variance(kVariance);
  constexpr int kDraws = 20000;
  const Columns values =
      in.directions * normal(kState + kModes, kDraws, 1) + normal(kValues, kDraws, 2);
  const VarianceScore score =
      variance_score(InnovationCovariance(in, 0), in.random.front().values, values);
  EXPECT_NEAR(score.scores.mean(), 0, 4 * std::sqrt(score.information / kDraws));
  EXPECT_NEAR(score.scores.squaredNorm() / kDraws / score.information, 1, 0.06);
}

TEST(VarianceGain, IsTheDifferenceOfDeviances) {
  const Innovation in = with_variance(kVariance);
  const VarianceGain gain = variance_gain(in, InnovationCovariance(in, 0));
  EXPECT_NEAR(gain.gain, deviance(0) - deviance(kVariance), 1e-8);
  // Its mean is tr S₀⁻¹ S − n − ln |S₀⁻¹ S| if S is the covariance.
  const MatrixXd one = MatrixXd::Identity(kValues, kValues);
  const auto dense = [&](const Innovation& i) {
    return MatrixXd(one + i.directions * i.directions.transpose());
  };
  const MatrixXd S = dense(in), S0 = dense(with_variance(0)), ratio = S0.ldlt().solve(S);
  EXPECT_NEAR(gain.mean, ratio.trace() - kValues - std::log(ratio.determinant()), 1e-8);
  EXPECT_NEAR(gain.variance, 2 * ((ratio - one) * (ratio - one)).trace(), 1e-7);
}

TEST(VarianceGain, IsNothingWithoutAVariance) {
  const Innovation in = with_variance(0);
  const VarianceGain gain = variance_gain(in, InnovationCovariance(in, 0));
  EXPECT_EQ(gain.gain, 0);
  EXPECT_EQ(gain.variance, 0);
}

}  // namespace
}  // namespace traceraft::assimilation
