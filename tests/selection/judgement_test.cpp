#include "verification/selection/search/judgement.hpp"

#include <gtest/gtest.h>

#include "verification/selection/search/explanation.hpp"

namespace traceraft::selection {
namespace {

constexpr double kMeasuredValues = 10000, kLevel = 0.02, kUsual = 0.5;

Refit refit_with(const std::vector<std::string>& effects, double deviance) {
  Refit fit;
  for (const std::string& effect : effects) {
    const assimilation::Candidate c = assimilation::find_candidate(effect).value();
    fit.hypothesis.parts.push_back({c, std::vector<double>(c.directions, 0.1)});
  }
  fit.deviance = deviance;
  const Eigen::Index n = fit.hypothesis.coefficients();
  fit.covariance = 0.01 * 0.01 * Eigen::MatrixXd::Identity(n, n);
  return fit;
}

CandidateScore score(const std::string& effect, double response, double resolution) {
  return {effect, {0.1}, 50, 1, 0.005, response, Eigen::MatrixXd::Identity(1, 1), resolution};
}

// The search for a first effect, which gravity explains best.
Round first_round() {
  Round round;
  round.screening.scores = {score("gravity", 0.3, 0.02), score("uptake", 0.3, 0.02)};
  round.screening.p = 0.005;
  round.screening.gap_p = 0.001;
  round.screening.mesh_error = 0.01;
  round.without = refit_with({}, 1000);
  round.refits = {refit_with({"gravity"}, 900), refit_with({"uptake"}, 950)};
  return round;
}

// `gap_beside`: is there a gap beside the best candidate, too?
Judgement judged(const Round& round, bool gap_beside = false) {
  return judge(round, kMeasuredValues, kLevel, kUsual, [&](const Refit& fit) {
    EXPECT_EQ(fit.hypothesis.name(), round.refits.front().hypothesis.name());
    return gap_beside;
  });
}

// A round that closes next to nothing of what was left is the last one.
TEST(Progress, IsWhatTheLastRoundHasClosed) {
  Explanation result;
  EXPECT_FALSE(closed_by_last_round(result));
  result.rounds = {first_round()};
  result.rounds.back().without.gap = {5, 5};
  result.found = refit_with({"gravity"}, 900);
  result.found.expected = {3, 3};
  result.found.gap = {4.9, 5};
  EXPECT_NEAR(closed_by_last_round(result).value(), (25 - 4.9 * 4.9) / 16, 1e-12);
  EXPECT_LT(closed_by_last_round(result).value(), kLeastProgress);
  result.found.gap = {3.5, 5};
  EXPECT_GT(closed_by_last_round(result).value(), kLeastProgress);
  result.rounds.back().without.gap = {3.01, 5};
  EXPECT_FALSE(closed_by_last_round(result)) << "so little may be noise";
}

// Rafts at rest agree with any D.
TEST(Judgement, FindsNothingOnlyWhereKineticsWereTested) {
  Round round = first_round();
  round.refits.clear();
  round.screening.p = 0.5;
  round.screening.gap_p = 0.5;
  round.without.diffusion_ratio_deviation = 0.9 * kKineticsUntested;
  EXPECT_EQ(judged(round).finding, Finding::none);
  round.without.diffusion_ratio_deviation = 1.1 * kKineticsUntested;
  EXPECT_EQ(judged(round).finding, Finding::not_identifiable);
}

TEST(Judgement, TakesWhatExplainsTheDataBest) {
  const Judgement judgement = judged(first_round());
  EXPECT_TRUE(judgement.taken);
  EXPECT_EQ(judgement.finding, Finding::named);
  EXPECT_EQ(judgement.equivalent, std::vector<std::string>{"gravity"});
}

TEST(Judgement, SaysWhatExplainsThemAsWell) {
  Round round = first_round();
  round.refits[1].deviance = 900 + 0.9 * kTelling;
  const Judgement judgement = judged(round);
  EXPECT_EQ(judgement.finding, Finding::ambiguous);
  EXPECT_EQ(judgement.equivalent, (std::vector<std::string>{"gravity", "uptake"}));
  const double limit = discrimination_limit(kMeasuredValues, round.screening.mesh_error);
  EXPECT_GT(limit, kTelling);
  round.refits[1].deviance = 900 + 0.99 * limit;
  EXPECT_EQ(judged(round).finding, Finding::ambiguous);
  round.refits[1].deviance = 900 + 1.01 * limit;
  EXPECT_EQ(judged(round).finding, Finding::named);
}

// 10,000 values with half of 0.02 of the noise each are one standard deviation of them all; the
// difference of two hypotheses has to be that much larger than what noise can make.
TEST(Judgement, DoubtsTheMeshInItsWorstShape) {
  EXPECT_NEAR(mesh_doubt(10000, 0.02), 1, 1e-12);
  EXPECT_NEAR(std::sqrt(discrimination_limit(10000, 0.02)), std::sqrt(kTelling) + 1, 1e-12);
  EXPECT_NEAR(discrimination_limit(10000, 0), kTelling, 1e-12);
}

TEST(Judgement, LetsASecondCoefficientEarnItsPlace) {
  Round round = first_round();
  round.refits = {refit_with({"exchange"}, 900), refit_with({"uptake"}, 900)};
  EXPECT_NEAR(
      criterion(round.refits[0], kMeasuredValues) - criterion(round.refits[1], kMeasuredValues),
      std::log(kMeasuredValues), 1e-9);
}

// Exchange that has next to nothing leave is uptake, and no other explanation.
TEST(Judgement, CountsNoSpecialCaseTwice) {
  Round round = first_round();
  round.refits = {refit_with({"uptake"}, 900), refit_with({"exchange"}, 898.1)};
  EXPECT_EQ(judged(round).finding, Finding::named);
  round.refits[1].deviance = 897.9;
  EXPECT_EQ(judged(round).equivalent, (std::vector<std::string>{"uptake", "exchange"}));
  // The other way about something has been gained.
  round.refits = {refit_with({"exchange"}, 890), refit_with({"uptake"}, 900)};
  EXPECT_EQ(judged(round).equivalent, (std::vector<std::string>{"exchange", "uptake"}));
  // Beside others as well.
  round.refits = {refit_with({"gravity", "uptake"}, 900), refit_with({"gravity", "exchange"}, 899)};
  EXPECT_EQ(judged(round).finding, Finding::named);
  round.refits[1] = refit_with({"cooling", "exchange"}, 899);
  EXPECT_EQ(judged(round).finding, Finding::ambiguous);
  round.refits[1] = refit_with({"exchange"}, 899);
  EXPECT_EQ(judged(round).finding, Finding::ambiguous);
}

// Gravity is ten standard deviations strong: as much as noise (the root of 6) and what
// extrapolation gets wrong, half of its last part in 10,000 values, can make where that part is
// 0.151 of the noise.
TEST(Judgement, TakesNothingThatNoiseAndTheMeshCouldBe) {
  Round round = first_round();
  round.screening.mesh_error = 0.152;
  EXPECT_FALSE(judged(round).taken);
  EXPECT_EQ(judged(round).finding, Finding::below_resolution);
  round.screening.mesh_error = 0.150;
  EXPECT_TRUE(judged(round).taken);
  // Beside an effect that was found it is none, and nothing more is said.
  round.screening.mesh_error = 0.152;
  round.screening.gap_p = 0.3;
  round.known.hypothesis = refit_with({"cooling"}, 0).hypothesis;
  for (Refit& fit : round.refits) fit = refit_with({"cooling", "gravity"}, fit.deviance);
  EXPECT_FALSE(judged(round).taken);
  EXPECT_EQ(judged(round).finding, Finding::named);
}

// The mesh is to blame only if what it could be would explain what is missing.
TEST(Judgement, SeesAGapBesideWhatTheMeshCouldBe) {
  Round round = first_round();
  round.screening.mesh_error = 0.152;
  EXPECT_EQ(judged(round, true).finding, Finding::unnamed);
  EXPECT_EQ(judged(round, true).without_gap, Finding::below_resolution);
  EXPECT_FALSE(judged(round, true).taken);
  round.screening.gap_p = 0.3;  // and none without it
  EXPECT_EQ(judged(round, true).finding, Finding::below_resolution);
  round.screening.gap_p = 0.001;
  round.screening.mesh_error = 0.150;
  EXPECT_TRUE(judged(round, true).taken);
}

// A finer mesh would not show what noise hides.
TEST(Judgement, BlamesTheMeshForNothingThatIsNoise) {
  Round round = first_round();
  round.screening.mesh_error = 0;
  round.refits.front().covariance *= 100 / (0.99 * kTelling);  // that certain
  EXPECT_FALSE(judged(round).taken);
  EXPECT_EQ(judged(round).finding, Finding::unnamed);
  round.screening.gap_p = 0.5;
  EXPECT_EQ(judged(round).finding, Finding::not_identifiable);
  round.refits.front().covariance *= 0.99 / 1.01;
  EXPECT_TRUE(judged(round).taken);
}

// Whatever the base model without any effect explains.
TEST(Judgement, CountsNoEffectOfStrengthZero) {
  Round round = first_round();
  round.refits.push_back(no_worse(refit_with({"bulk-mobility"}, 1e9), refit_with({}, 901)));
  EXPECT_EQ(judged(round).equivalent, std::vector<std::string>{"gravity"});
  round.refits.back().hypothesis.parts.back().coefficients[0] = 1e-6;
  EXPECT_EQ(judged(round).equivalent, (std::vector<std::string>{"gravity", "bulk-mobility"}));
}

// The strength and the certainty of the refitted effect are what counts.
TEST(Judgement, HoldsRefittedStrengthsAgainstTheMesh) {
  Refit fit = refit_with({"exchange", "gravity"}, 900);
  EXPECT_TRUE(resolved(fit, 1, kMeasuredValues, 0.150));
  EXPECT_FALSE(resolved(fit, 1, kMeasuredValues, 0.152));
  fit.hypothesis.parts[1].coefficients[0] *= 1.2;
  EXPECT_TRUE(resolved(fit, 1, kMeasuredValues, 0.152));
  fit.covariance(2, 2) *= 1.5;
  EXPECT_FALSE(resolved(fit, 1, kMeasuredValues, 0.152));
  // Both coefficients of exchange together.
  EXPECT_TRUE(resolved(fit, 0, kMeasuredValues, 0.233));
  EXPECT_FALSE(resolved(fit, 0, kMeasuredValues, 0.235));
  EXPECT_TRUE(resolved(fit, 0, kMeasuredValues / 2, 0.235));
}

// A refit that went astray says no less than that without its effect.
TEST(Refit, IsNoWorseThanWithoutItsEffect) {
  const Refit without = refit_with({"uptake"}, 900),
              astray = refit_with({"uptake", "exchange"}, 968);
  const Refit better = refit_with({"uptake", "exchange"}, 890);
  EXPECT_EQ(no_worse(better, without).deviance, 890);
  const Refit fit = no_worse(astray, without);
  EXPECT_EQ(fit.deviance, 900);
  EXPECT_EQ(fit.hypothesis.name(), "uptake + exchange");
  EXPECT_EQ(fit.hypothesis.parts[0].coefficients, std::vector<double>{0.1});
  EXPECT_EQ(fit.hypothesis.parts[1].coefficients, (std::vector<double>{0, 0}));
  ASSERT_EQ(fit.covariance.rows(), 3);
  EXPECT_EQ(fit.covariance(0, 0), without.covariance(0, 0));
}

TEST(Judgement, AdmitsAGapThatNothingExplains) {
  Round round = first_round();
  round.refits.clear();
  EXPECT_EQ(judged(round).finding, Finding::unnamed);
  round = first_round();
  for (Refit& fit : round.refits) fit.deviance = round.without.deviance - 1;
  EXPECT_FALSE(judged(round).taken);
  EXPECT_EQ(judged(round).finding, Finding::unnamed);
  // Beside an effect that was found, too.
  EXPECT_EQ(judged(round).without_gap, Finding::not_identifiable);
  round.known.hypothesis = refit_with({"cooling"}, 0).hypothesis;
  EXPECT_EQ(judged(round).finding, Finding::unnamed);
  EXPECT_EQ(judged(round).without_gap, Finding::named);
  round.screening.gap_p = 0.3;
  EXPECT_EQ(judged(round).finding, Finding::named);
}

// A gap of any shape has to be less probable than a candidate.
TEST(Judgement, IsSlowToAdmitAGap) {
  Round round = first_round();
  round.refits.clear();
  round.screening.gap_p = 0.0019;
  EXPECT_EQ(judged(round).finding, Finding::unnamed);
  round.screening.gap_p = 0.0021;
  EXPECT_EQ(judged(round).finding, Finding::not_identifiable);
}

TEST(Judgement, KnowsWhatDataCannotShow) {
  Round round = first_round();
  round.refits.clear();
  round.screening.p = round.screening.gap_p = 0.5;
  EXPECT_EQ(judged(round).finding, Finding::none);
  for (CandidateScore& s : round.screening.scores) s.resolution = kUsual;
  EXPECT_EQ(judged(round).finding, Finding::not_identifiable);
}

TEST(Judgement, SaysThatTooLittleIsMissingToNameIt) {
  Round round = first_round();
  round.screening.gap_p = 0.5;
  for (Refit& fit : round.refits) fit.deviance = round.without.deviance - 1;
  EXPECT_FALSE(judged(round).taken);
  EXPECT_EQ(judged(round).finding, Finding::not_identifiable);
}

TEST(Judgement, HasAWordForEveryFinding) {
  EXPECT_EQ(word_for(Finding::not_identifiable), "not-identifiable");
  EXPECT_EQ(word_for(Finding::below_resolution), "below-solver-resolution");
}

}  // namespace
}  // namespace traceraft::selection
