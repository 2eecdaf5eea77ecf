// What counts as right in a campaign, on verdicts that are written down by hand.
#include "drivers/campaign/case_outcome.hpp"

#include <gtest/gtest.h>

#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

Verdict verdict(Finding finding, const std::vector<std::string>& members = {}) {
  Verdict result;
  result.finding = finding;
  result.members = members;
  return result;
}

CaseOutcome named(const std::string& hidden, const Verdict& verdict) {
  return outcome_of(Aim::name, hidden, verdict);
}

TEST(CaseOutcome, IsRightForTheNameAlone) {
  EXPECT_EQ(named("gravity", verdict(Finding::named, {"gravity"})), CaseOutcome::right);
  EXPECT_EQ(named("gravity + uptake", verdict(Finding::named, {"uptake + gravity"})),
            CaseOutcome::right);
  EXPECT_EQ(named("gravity", verdict(Finding::named, {"uptake"})), CaseOutcome::wrong);
  EXPECT_EQ(named("gravity", verdict(Finding::named, {"gravity + uptake"})), CaseOutcome::wrong);
  EXPECT_EQ(named("gravity", verdict(Finding::none)), CaseOutcome::missed);
  EXPECT_EQ(named("gravity", verdict(Finding::unnamed)), CaseOutcome::missed);
}

TEST(CaseOutcome, IsInClassWhereOneIsDeclared) {
  EXPECT_EQ(named("gravity", verdict(Finding::ambiguous, {"gravity", "uptake"})),
            CaseOutcome::in_class);
  EXPECT_EQ(named("gravity", verdict(Finding::ambiguous, {"uptake", "gravity"})),
            CaseOutcome::in_class);
  EXPECT_EQ(named("gravity", verdict(Finding::ambiguous, {"uptake", "exchange"})),
            CaseOutcome::wrong);
  EXPECT_EQ(named("gravity + uptake",
                  verdict(Finding::ambiguous, {"exchange + gravity", "uptake + gravity"})),
            CaseOutcome::in_class);
}

TEST(CaseOutcome, MissesAPartOfWhatIsHidden) {
  EXPECT_EQ(named("gravity + uptake", verdict(Finding::named, {"uptake"})), CaseOutcome::missed);
  EXPECT_EQ(named("gravity + uptake", verdict(Finding::named, {"exchange"})), CaseOutcome::wrong);
}

TEST(CaseOutcome, OfNothingHiddenIsNone) {
  const auto of = [](const Verdict& v) { return outcome_of(Aim::nothing, "", v); };
  EXPECT_EQ(of(verdict(Finding::none)), CaseOutcome::right);
  EXPECT_EQ(of(verdict(Finding::unnamed)), CaseOutcome::wrong);
  EXPECT_EQ(of(verdict(Finding::named, {"gravity"})), CaseOutcome::wrong);
  EXPECT_EQ(of(verdict(Finding::below_resolution)), CaseOutcome::missed);
}

TEST(CaseOutcome, OfWhatIsNotLookedForIsUnnamed) {
  const auto of = [](const Verdict& v) { return outcome_of(Aim::unnamed, "gravity", v); };
  EXPECT_EQ(of(verdict(Finding::unnamed)), CaseOutcome::right);
  EXPECT_EQ(of(verdict(Finding::none)), CaseOutcome::missed);
  EXPECT_EQ(of(verdict(Finding::ambiguous, {"uptake", "exchange"})), CaseOutcome::wrong);
}

TEST(CaseOutcome, HasWordsThatAreReadBack) {
  for (const CaseOutcome outcome :
       {CaseOutcome::right, CaseOutcome::in_class, CaseOutcome::missed, CaseOutcome::wrong})
    EXPECT_EQ(outcome_of(word_for(outcome)), outcome);
  EXPECT_THROW(outcome_of("perhaps"), InputError);
}

// A rate is one over the truth's unit of time, which goes with its D.
TEST(StrengthError, IsInUnitsOfTheTruth) {
  Units units;
  HiddenTruth truth{{{"uptake", {0.2}}}, 1.5, 0.03};
  Units own = units;
  own.diffusion_cm2_s *= 1.5;
  const double rate = 0.2 / own.time();
  Verdict found = verdict(Finding::named, {"uptake"});
  found.parameters = {{"uptake", "rate", "1/s", 0.9 * rate, 0.05 * rate}};
  const auto error = strength_error(truth, units, found);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->relative, 0.1, 1e-9);
  EXPECT_NEAR(error->deviations, -2, 1e-9);
  found.finding = Finding::unnamed;  // it only comes closest
  EXPECT_FALSE(strength_error(truth, units, found));
  found = verdict(Finding::named, {"exchange"});
  EXPECT_FALSE(strength_error(truth, units, found));
  truth.effects.clear();
  EXPECT_FALSE(strength_error(truth, units, found));
}

// Where sizing stopped the search has to stop, too: that it does is no success.
TEST(StrengthError, IsNoneAtTheEndOfARange) {
  const auto of_truth = [](double strength) {
    Verdict found = verdict(Finding::named, {"mobility-contrast"});
    found.parameters = {{"mobility-contrast", "strength", "", 1.0, 0.1}};
    return strength_error({{{"mobility-contrast", {strength}}}, 1, 0.03}, {}, found);
  };
  EXPECT_TRUE(of_truth(0.9));
  EXPECT_FALSE(of_truth(1));
  EXPECT_FALSE(of_truth(-1));
}

}  // namespace
}  // namespace traceraft
