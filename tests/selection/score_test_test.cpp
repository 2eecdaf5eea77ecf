// The score test on passes whose information and scores are written down by hand.
#include "verification/selection/fit/score_test.hpp"

#include <gtest/gtest.h>

#include "kernel/core/random.hpp"

namespace traceraft::selection {
namespace {

constexpr int kDraws = 400;

// D, mesh, then gravity (two-sided), uptake (two-sided), exchange (two, not negative).
const std::vector<assimilation::Candidate>& screened() {
  static const std::vector<assimilation::Candidate> list{
      assimilation::find_candidate("gravity").value(),
      assimilation::find_candidate("uptake").value(),
      assimilation::find_candidate("exchange").value()};
  return list;
}
constexpr Eigen::Index kParameters = assimilation::kFirstParameter + 4;

// Scores of noise have the information as their covariance.
assimilation::FilterResult pass_with(const Eigen::MatrixXd& information) {
  assimilation::FilterResult pass;
  pass.information = information;
  pass.score = Vec::Zero(kParameters);
  Eigen::MatrixXd z(kParameters, kDraws);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    z.data()[i] = normal_random(1, 1, static_cast<std::uint64_t>(i));
  pass.null_scores = Eigen::MatrixXd(information.llt().matrixL()) * z;
  assimilation::Innovation in{};
  in.values = Vec::Zero(10);
  in.parameters = assimilation::Columns::Ones(10, kParameters);
  pass.innovations.push_back(in);
  return pass;
}

const CandidateScore& score_of(const Screening& screening, const std::string& effect) {
  for (const CandidateScore& score : screening.scores)
    if (score.effect == effect) return score;
  throw std::logic_error(effect);
}

TEST(ScoreTest, GainsWhatTheLikelihoodDoes) {
  assimilation::FilterResult pass =
      pass_with(4 * Eigen::MatrixXd::Identity(kParameters, kParameters));
  pass.score[2] = 20;  // gravity
  pass.score[3] = -6;  // uptake
  const Screening screening = screen(pass, screened(), {});
  EXPECT_EQ(screening.scores.front().effect, "gravity");
  EXPECT_NEAR(screening.scores.front().score, 20 * 20 / 4.0, 1e-9);
  EXPECT_NEAR(screening.scores.front().coefficients[0], 5, 1e-9);
  EXPECT_NEAR(screening.scores.front().covariance(0, 0), 0.25, 1e-9);
  EXPECT_NEAR(score_of(screening, "uptake").coefficients[0], -1.5, 1e-9);
  EXPECT_NEAR(score_of(screening, "gravity").null_mean, 1, 0.2);
  EXPECT_NEAR(screening.p, 1.0 / (kDraws + 1), 1e-12);
}

// Coefficients that may not be negative are 0 then, and noise gains half as much by them.
TEST(ScoreTest, KeepsSigns) {
  assimilation::FilterResult pass = pass_with(Eigen::MatrixXd::Identity(kParameters, kParameters));
  pass.score[4] = -5;
  pass.score[5] = 3;
  const Screening screening = screen(pass, screened(), {});
  const CandidateScore& exchange = score_of(screening, "exchange");
  EXPECT_EQ(exchange.coefficients[0], 0);
  EXPECT_NEAR(exchange.coefficients[1], 3, 1e-9);
  EXPECT_NEAR(exchange.score, 9, 1e-9);
  EXPECT_NEAR(exchange.null_mean, 1, 0.2);
}

// A score that a nuisance explains as well is no evidence.
TEST(ScoreTest, ProjectsNuisancesOut) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(kParameters, kParameters);
  information(assimilation::kDiffusionRatio, 2) = information(2, assimilation::kDiffusionRatio) =
      0.8;
  assimilation::FilterResult pass = pass_with(information);
  pass.score[assimilation::kDiffusionRatio] = 10;
  pass.score[2] = 8 + 1;  // what a diffusion ratio of 10 makes of it, and 1
  const Screening screening = screen(pass, screened(), {});
  EXPECT_NEAR(score_of(screening, "gravity").score, 1 / (1 - 0.64), 1e-9);
  EXPECT_GT(screening.p, 0.2);
}

// The level of p, over all candidates, is what it says.
TEST(ScoreTest, CallsNoiseNoise) {
  assimilation::FilterResult pass = pass_with(Eigen::MatrixXd::Identity(kParameters, kParameters));
  int alarms = 0;
  constexpr int kTrials = 300;
  for (int k = 0; k < kTrials; ++k) {
    for (Eigen::Index i = 0; i < kParameters; ++i)
      pass.score[i] =
          normal_random(2, static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(i));
    alarms += screen(pass, screened(), {}).p <= 0.1;
  }
  EXPECT_NEAR(alarms, 0.1 * kTrials, 4 * std::sqrt(0.09 * kTrials));
}

TEST(ScoreTest, SeesNothingWhereNothingResponds) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(kParameters, kParameters);
  information(2, 2) = 1e-12;
  assimilation::FilterResult pass = pass_with(information);
  pass.score[2] = 1e-3;
  const Screening screening = screen(pass, screened(), {});
  EXPECT_EQ(score_of(screening, "gravity").score, 0);
  EXPECT_EQ(score_of(screening, "gravity").covariance(0, 0), 0);
}

// One of the two coefficients of exchange is uptake once more when uptake is found.
TEST(ScoreTest, LeavesOutCoefficientsThatAreKnownAlready) {
  const assimilation::Hypothesis known{{{assimilation::find_candidate("uptake").value(), {1}}}};
  const std::vector<assimilation::Candidate> left{assimilation::find_candidate("gravity").value(),
                                                  assimilation::find_candidate("exchange").value()};
  // D, mesh, uptake, gravity, exchange: the last is uptake but for roundoff.
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(kParameters, kParameters);
  information(2, 5) = information(5, 2) = 1 - 1e-15;
  assimilation::FilterResult pass = pass_with(Eigen::MatrixXd::Identity(kParameters, kParameters));
  pass.information = information;
  pass.score[4] = 3;
  pass.score[5] = 1e-6;
  const Screening screening = screen(pass, left, known);
  const CandidateScore& exchange = score_of(screening, "exchange");
  EXPECT_NEAR(exchange.score, 9, 1e-6);
  EXPECT_NEAR(exchange.covariance(0, 0), 1, 1e-9);
  EXPECT_EQ(exchange.covariance(1, 1), 0);
  EXPECT_EQ(exchange.coefficients[1], 0);
}

// One of two coefficients that do the same is left.
TEST(ScoreTest, LeavesOutCoefficientsThatAreAlike) {
  assimilation::FilterResult pass = pass_with(Eigen::MatrixXd::Identity(kParameters, kParameters));
  pass.information(4, 5) = pass.information(5, 4) = 1 - 1e-15;
  pass.score[4] = pass.score[5] = 3;
  const Screening screening = screen(pass, screened(), {});
  const CandidateScore& exchange = score_of(screening, "exchange");
  EXPECT_NEAR(exchange.score, 9, 1e-6);
  EXPECT_NEAR(exchange.covariance(0, 0), 1, 1e-9);
  EXPECT_EQ(exchange.covariance(1, 1), 0);
}

// 25 patterns of normal size each in the replicates: their squares add up to chi squared, whose
// tail beyond 37.65 is 0.05, and beyond 73.1, further than any of 400 goes, 1.4e-6.
TEST(ScoreTest, JoinsGapsThatCountAndThatAreHeldOut) {
  constexpr int kPatterns = 25;
  assimilation::FilterResult pass = pass_with(Eigen::MatrixXd::Identity(kParameters, kParameters));
  const auto parts = [](double squares, std::uint64_t seed) {
    assimilation::Columns all = assimilation::Columns::Zero(kPatterns, 1 + kParameters + kDraws);
    all.col(0).setConstant(std::sqrt(squares / kPatterns));
    for (Eigen::Index r = 0; r < kDraws; ++r)
      for (Eigen::Index i = 0; i < kPatterns; ++i)
        all(i, 1 + kParameters + r) =
            normal_random(seed, static_cast<std::uint64_t>(r), static_cast<std::uint64_t>(i));
    return all;
  };
  pass.gap_parts = {parts(37.65, 5)};
  const Screening alone = screen(pass, {}, {});
  EXPECT_NEAR(alone.train_gap_p, 0.05, 0.015);
  EXPECT_EQ(alone.gap_p, alone.train_gap_p);
  pass.heldout_gap_parts = {parts(37.65, 6)};
  const Screening both = screen(pass, {}, {});
  EXPECT_NEAR(both.heldout_gap_p, 0.05, 0.015);
  EXPECT_NEAR(both.gap_p, 0.05 * 0.05 * (1 - std::log(0.05 * 0.05)), 0.006);
  // The same twice is no better evidence than once.
  pass.heldout_gap_parts = pass.gap_parts;
  EXPECT_NEAR(screen(pass, {}, {}).gap_p, alone.gap_p, 0.01);
  pass.heldout_gap_parts.clear();
  pass.gap_parts = {parts(73.1, 5)};
  const double p = screen(pass, {}, {}).gap_p;
  EXPECT_LT(p, 1e-5);
  EXPECT_GT(p, 1e-7);
}

TEST(ScoreTest, KnowsTheTailsOfSumsOfSquares) {
  EXPECT_EQ(gamma_tail(Vec::Constant(9, 2), 2), 1);
  EXPECT_EQ(gamma_tail(Vec::Constant(9, 2), 3), 0);
  // An exponential has e^−x, which a mean and a variance of 1 make.
  Vec two(2);
  two << 1 - std::sqrt(0.5), 1 + std::sqrt(0.5);
  EXPECT_NEAR(gamma_tail(two, 3), std::exp(-3), 1e-12);
}

// A gap that nuisances explain is none; the replicates are freed of it as well.
TEST(ScoreTest, FreesGapsOfNuisances) {
  assimilation::FilterResult pass = pass_with(Eigen::MatrixXd::Identity(kParameters, kParameters));
  assimilation::Columns row = assimilation::Columns::Zero(1, 1 + kParameters + kDraws);
  row(0, 0) = 10;
  row(0, 1 + assimilation::kDiffusionRatio) = 2;
  for (int r = 0; r < kDraws; ++r)
    row(0, 1 + kParameters + r) = 1 + 2 * pass.null_scores(assimilation::kDiffusionRatio, r);
  pass.gap_parts = {row};
  pass.score[assimilation::kDiffusionRatio] = 5;  // the diffusion ratio explains all of it
  EXPECT_EQ(screen(pass, {}, {}).train_gap_p, 1);
  pass.score[assimilation::kDiffusionRatio] = 4;
  EXPECT_LT(screen(pass, {}, {}).train_gap_p, 1e-12);
}

TEST(ScoreTest, MayHaveNothingToLookFor) {
  assimilation::FilterResult pass = pass_with(Eigen::MatrixXd::Identity(kParameters, kParameters));
  pass.score[assimilation::kDiffusionRatio] = 2;
  const Screening screening = screen(pass, {}, {});
  EXPECT_TRUE(screening.scores.empty());
  EXPECT_EQ(screening.p, 1);
  EXPECT_NEAR(screening.diffusion_ratio_change, 2, 1e-9);
}

}  // namespace
}  // namespace traceraft::selection
