#include "verification/explain/judgement.hpp"

#include <gtest/gtest.h>

namespace traceraft {
namespace {

constexpr double kMeasuredValues = 10000, kLevel = 0.02, kUsual = 0.5;

Refit refit_with(const std::vector<std::string>& effects, double deviance) {
  Refit fit;
  for (const std::string& effect : effects) {
    const Candidate c = find_candidate(effect).value();
    fit.hypothesis.parts.push_back({c, std::vector<double>(c.directions, 0.1)});
  }
  fit.deviance = deviance;
  return fit;
}

// With a coefficient of 0.1, to which the response is.
CandidateScore score(const std::string& effect, double response, double resolution) {
  const double deviation = 0.1 * resolution / response;
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(1, 1, deviation * deviation);
  return {effect, {0.1}, 50, 1, 0.005, response, covariance, resolution};
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

Judgement judged(const Round& round) {
  return judge(round, kMeasuredValues, kLevel, kUsual);
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
  round.refits[1].deviance = 900 + 1.1 * kTelling;
  EXPECT_EQ(judged(round).finding, Finding::named);
}

TEST(Judgement, LetsASecondCoefficientEarnItsPlace) {
  Round round = first_round();
  round.refits = {refit_with({"exchange"}, 900), refit_with({"uptake"}, 900)};
  EXPECT_NEAR(
      criterion(round.refits[0], kMeasuredValues) - criterion(round.refits[1], kMeasuredValues),
      std::log(kMeasuredValues), 1e-9);
}

TEST(Judgement, TakesNothingThatTheMeshChangesAsMuch) {
  Round round = first_round();
  round.screening.mesh_error = 0.11;
  EXPECT_FALSE(judged(round).taken);
  EXPECT_EQ(judged(round).finding, Finding::below_resolution);
  round.screening.mesh_error = 0.09;
  EXPECT_TRUE(judged(round).taken);
}

TEST(Judgement, LooksForResolutionInAllRounds) {
  Round first = first_round(), second = first_round();
  first.screening.mesh_error = 0.01;
  second.screening.mesh_error = 1;
  const Hypothesis both = refit_with({"gravity", "uptake"}, 0).hypothesis;
  EXPECT_TRUE(resolved({first, second}, both));
  EXPECT_FALSE(resolved({second}, both));
  EXPECT_FALSE(resolved({first}, refit_with({"gravity", "cooling"}, 0).hypothesis));
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
  round.known.hypothesis = refit_with({"cooling"}, 0).hypothesis;
  EXPECT_EQ(judged(round).finding, Finding::unnamed);
  round.screening.gap_p = 0.3;
  EXPECT_EQ(judged(round).finding, Finding::named);
}

// A gap of any shape has to be less probable than a candidate.
TEST(Judgement, IsSlowToAdmitAGap) {
  Round round = first_round();
  round.refits.clear();
  round.screening.gap_p = 0.99 * kGapLevel * kLevel;
  EXPECT_EQ(judged(round).finding, Finding::unnamed);
  round.screening.gap_p = 0.0051;
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

// What counts is how strong the effect is that was refitted, not how strong it seemed before.
TEST(Judgement, HoldsRefittedStrengthsAgainstTheMesh) {
  Round round = first_round();
  round.refits[0].hypothesis.parts[0].coefficients[0] = 0.005;
  EXPECT_FALSE(judged(round).taken);
  round.refits[0].hypothesis.parts[0].coefficients[0] = 0.05;
  EXPECT_TRUE(judged(round).taken);
}

TEST(Judgement, HasAWordForEveryFinding) {
  EXPECT_EQ(word_for(Finding::not_identifiable), "not-identifiable");
  EXPECT_EQ(word_for(Finding::below_resolution), "below-solver-resolution");
}

}  // namespace
}  // namespace traceraft
