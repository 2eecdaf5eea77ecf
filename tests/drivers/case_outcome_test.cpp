// The outcomes of a campaign that count as right, on verdicts that are written down by hand.
#include "drivers/campaign/case_outcome.hpp"

#include <gtest/gtest.h>

#include "kernel/core/error.hpp"
#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft {
namespace {

explain::Verdict verdict(selection::Finding finding, const std::vector<std::string>& members = {}) {
  explain::Verdict result;
  result.finding = finding;
  result.members = members;
  return result;
}

campaign::CaseOutcome named(const std::string& hidden, const explain::Verdict& verdict) {
  return campaign::outcome_of(campaign::Aim::name, hidden, verdict);
}

TEST(CaseOutcome, IsRightForTheNameAlone) {
  EXPECT_EQ(named("gravity", verdict(selection::Finding::named, {"gravity"})),
            campaign::CaseOutcome::right);
  EXPECT_EQ(named("gravity + uptake", verdict(selection::Finding::named, {"uptake + gravity"})),
            campaign::CaseOutcome::right);
  EXPECT_EQ(named("gravity", verdict(selection::Finding::named, {"uptake"})),
            campaign::CaseOutcome::wrong);
  EXPECT_EQ(named("gravity", verdict(selection::Finding::named, {"gravity + uptake"})),
            campaign::CaseOutcome::wrong);
  EXPECT_EQ(named("gravity", verdict(selection::Finding::none)), campaign::CaseOutcome::missed);
  EXPECT_EQ(named("gravity", verdict(selection::Finding::unnamed)), campaign::CaseOutcome::missed);
}

TEST(CaseOutcome, IsInClassWhereOneIsDeclared) {
  EXPECT_EQ(named("gravity", verdict(selection::Finding::ambiguous, {"gravity", "uptake"})),
            campaign::CaseOutcome::in_class);
  EXPECT_EQ(named("gravity", verdict(selection::Finding::ambiguous, {"uptake", "gravity"})),
            campaign::CaseOutcome::in_class);
  EXPECT_EQ(named("gravity", verdict(selection::Finding::ambiguous, {"uptake", "exchange"})),
            campaign::CaseOutcome::wrong);
  EXPECT_EQ(named("gravity + uptake", verdict(selection::Finding::ambiguous,
                                              {"exchange + gravity", "uptake + gravity"})),
            campaign::CaseOutcome::in_class);
}

TEST(CaseOutcome, MissesAPartOfWhatIsHidden) {
  EXPECT_EQ(named("gravity + uptake", verdict(selection::Finding::named, {"uptake"})),
            campaign::CaseOutcome::missed);
  EXPECT_EQ(named("gravity + uptake", verdict(selection::Finding::named, {"exchange"})),
            campaign::CaseOutcome::wrong);
}

TEST(CaseOutcome, OfNothingHiddenIsNone) {
  const auto of = [](const explain::Verdict& v) {
    return campaign::outcome_of(campaign::Aim::nothing, "", v);
  };
  EXPECT_EQ(of(verdict(selection::Finding::none)), campaign::CaseOutcome::right);
  EXPECT_EQ(of(verdict(selection::Finding::unnamed)), campaign::CaseOutcome::wrong);
  EXPECT_EQ(of(verdict(selection::Finding::named, {"gravity"})), campaign::CaseOutcome::wrong);
  EXPECT_EQ(of(verdict(selection::Finding::below_resolution)), campaign::CaseOutcome::missed);
}

TEST(CaseOutcome, OfWhatIsNotLookedForIsUnnamed) {
  const auto of = [](const explain::Verdict& v) {
    return campaign::outcome_of(campaign::Aim::unnamed, "gravity", v);
  };
  EXPECT_EQ(of(verdict(selection::Finding::unnamed)), campaign::CaseOutcome::right);
  EXPECT_EQ(of(verdict(selection::Finding::none)), campaign::CaseOutcome::missed);
  EXPECT_EQ(of(verdict(selection::Finding::ambiguous, {"uptake", "exchange"})),
            campaign::CaseOutcome::wrong);
}

TEST(CaseOutcome, HasWordsThatAreReadBack) {
  for (const campaign::CaseOutcome outcome :
       {campaign::CaseOutcome::right, campaign::CaseOutcome::in_class,
        campaign::CaseOutcome::missed, campaign::CaseOutcome::wrong})
    EXPECT_EQ(campaign::outcome_of(campaign::word_for(outcome)), outcome);
  EXPECT_THROW(campaign::outcome_of("perhaps"), InputError);
}

// A rate is one over the truth's unit of time, which goes with its D.
TEST(StrengthError, IsInUnitsOfTheTruth) {
  physics::Units units;
  campaign::HiddenTruth truth{{{"uptake", {0.2}}}, 1.5, 0.03};
  physics::Units own = units;
  own.diffusion_cm2_s *= 1.5;
  const double rate = 0.2 / own.time();
  explain::Verdict found = verdict(selection::Finding::named, {"uptake"});
  found.parameters = {{"uptake", "rate", "1/s", 0.9 * rate, 0.05 * rate}};
  const auto error = campaign::strength_error(truth, units, found);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->relative, 0.1, 1e-9);
  EXPECT_NEAR(error->deviations, -2, 1e-9);
  found.finding = selection::Finding::unnamed;  // it only comes closest
  EXPECT_FALSE(campaign::strength_error(truth, units, found));
  found = verdict(selection::Finding::named, {"exchange"});
  EXPECT_FALSE(campaign::strength_error(truth, units, found));
  truth.effects.clear();
  EXPECT_FALSE(campaign::strength_error(truth, units, found));
}

// Flow is two effects to be found, each with its own strength.
TEST(StrengthError, OfBrownianFlowIsThatOfItsThermalStrength) {
  const campaign::HiddenTruth truth{
      {assimilation::find_candidate("brownian-flow")->term({0.002})}, 1, 0.03};
  EXPECT_EQ(campaign::names_of(truth.effects), "brownian-flow");
  explain::Verdict found = verdict(selection::Finding::named, {"brownian-flow"});
  found.parameters = {{"brownian-flow", "water", "", 1.25, {}},
                      {"brownian-flow", "thermal", "", 0.0018, 0.0001}};
  const auto error = campaign::strength_error(truth, {}, found);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->relative, 0.1, 1e-9);
  EXPECT_NEAR(error->deviations, -2, 1e-9);
}

// Where sizing stopped the search has to stop, too: that it does is no success.
TEST(StrengthError, IsNoneAtTheEndOfARange) {
  const auto of_truth = [](double strength) {
    explain::Verdict found = verdict(selection::Finding::named, {"mobility-contrast"});
    found.parameters = {{"mobility-contrast", "strength", "", 1.0, 0.1}};
    return campaign::strength_error({{{"mobility-contrast", {strength}}}, 1, 0.03}, {}, found);
  };
  EXPECT_TRUE(of_truth(0.9));
  EXPECT_FALSE(of_truth(1));
  EXPECT_FALSE(of_truth(-1));
}

}  // namespace
}  // namespace traceraft
