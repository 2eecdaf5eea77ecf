// Optima at the ends of ranges, on passes whose information and scores are written down by hand.
#include "verification/selection/fit/free_parameters.hpp"

#include <gtest/gtest.h>

namespace traceraft::selection {
namespace {

using Indices = std::vector<Eigen::Index>;

// Exchange, whose two coefficients may not be negative, then gravity, which may be anything.
assimilation::Hypothesis hypothesis(double first, double second) {
  return {{{assimilation::find_candidate("exchange").value(), {first, second}},
           {assimilation::find_candidate("gravity").value(), {0}}}};
}

assimilation::FilterResult pass_of_score(const Vec& score) {
  assimilation::FilterResult pass;
  pass.information = Eigen::MatrixXd::Identity(5, 5);
  pass.score = score;
  return pass;
}

TEST(FreeParameters, AreAllWithinTheirRanges) {
  const assimilation::FilterResult pass = pass_of_score(Vec::Constant(5, -1));
  EXPECT_EQ(free_parameters(pass, hypothesis(1, 1)), (Indices{0, 1, 2, 3, 4}));
  EXPECT_EQ(free_parameters(pass, {}), (Indices{0, 1}));
}

TEST(FreeParameters, StayWhereTheyCannotGoFurther) {
  const assimilation::FilterResult down = pass_of_score(Vec::Constant(5, -1)),
                                   up = pass_of_score(Vec::Constant(5, 1));
  EXPECT_EQ(free_parameters(down, hypothesis(0, 1)), (Indices{0, 1, 3, 4}));
  EXPECT_EQ(free_parameters(down, hypothesis(0, 0)), (Indices{0, 1, 4}));
  EXPECT_EQ(free_parameters(up, hypothesis(0, 0)), (Indices{0, 1, 2, 3, 4}));
}

TEST(FreeParameters, StayBelowTheUpperEnd) {
  const assimilation::Candidate asymmetry = assimilation::find_candidate("asymmetry").value();
  const auto at = [&](double value) { return assimilation::Hypothesis{{{asymmetry, {value}}}}; };
  assimilation::FilterResult pass = pass_of_score(Vec::Constant(5, 1));
  EXPECT_EQ(free_parameters(pass, at(asymmetry.most)), (Indices{0, 1}));
  EXPECT_EQ(free_parameters(pass, at(0.9 * asymmetry.most)), (Indices{0, 1, 2}));
  EXPECT_EQ(free_parameters(pass, at(asymmetry.least)), (Indices{0, 1, 2}));
  pass.score *= -1;
  EXPECT_EQ(free_parameters(pass, at(asymmetry.most)), (Indices{0, 1, 2}));
  EXPECT_EQ(free_parameters(pass, at(asymmetry.least)), (Indices{0, 1}));
}

// The other coefficients explain what one that is held would explain, and they may be free then.
TEST(FreeParameters, HaveTheirOptimumBesideThoseThatAreHeld) {
  assimilation::FilterResult pass = pass_of_score(Vec::Zero(5));
  pass.information(assimilation::kDiffusionRatio, 2) =
      pass.information(2, assimilation::kDiffusionRatio) = 0.8;
  pass.score[assimilation::kDiffusionRatio] = 1;
  pass.score[2] = -1;  // together: diffusion ratio 5, coefficient −5
  const Indices free = free_parameters(pass, hypothesis(0, 1));
  EXPECT_EQ(free, (Indices{0, 1, 3, 4}));
  EXPECT_NEAR(newton_step(pass, free)[0], 1, 1e-12);
  EXPECT_NEAR(newton_step(pass, free_parameters(pass, hypothesis(9, 1)))[0], 5, 1e-12);
}

// The covariance of those that are free does not know of those that are held.
TEST(FreeParameters, HaveACovarianceOfTheirOwn) {
  Eigen::MatrixXd information = 2 * Eigen::MatrixXd::Identity(3, 3);
  information(0, 2) = information(2, 0) = 1;
  const Eigen::MatrixXd held = covariance_beside_held(information, {0, 1});
  EXPECT_NEAR(held(0, 0), 1 / 2.0, 1e-12);
  EXPECT_NEAR(held(2, 2), 2 / 3.0, 1e-12);
  EXPECT_EQ(held(0, 2), 0);
  const Eigen::MatrixXd all = covariance_beside_held(information, {0, 1, 2});
  EXPECT_NEAR(all(0, 0), 2 / 3.0, 1e-12);
  EXPECT_NEAR(all(0, 2), -1 / 3.0, 1e-12);
}

}  // namespace
}  // namespace traceraft::selection
