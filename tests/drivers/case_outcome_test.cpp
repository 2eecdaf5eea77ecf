// What counts as right in a campaign, on verdicts that are written down by hand.
#include "drivers/campaign/case_outcome.hpp"

#include <gtest/gtest.h>

#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

Json verdict(const std::string& word, const std::string& effect = "",
             const std::vector<std::string>& others = {}) {
  std::vector<std::string> all{effect};
  all.insert(all.end(), others.begin(), others.end());
  return {{"verdict", word},
          {"effect", effect.empty() ? Json() : Json(effect)},
          {"class", effect.empty() ? Json::array() : Json(all)}};
}

CaseOutcome named(const std::string& hidden, const Json& verdict) {
  return outcome_of(Aim::name, hidden, verdict);
}

TEST(CaseOutcome, IsRightForTheNameAlone) {
  EXPECT_EQ(named("gravity", verdict("named", "gravity")), CaseOutcome::right);
  EXPECT_EQ(named("gravity + uptake", verdict("named", "uptake + gravity")), CaseOutcome::right);
  EXPECT_EQ(named("gravity", verdict("named", "uptake")), CaseOutcome::wrong);
  EXPECT_EQ(named("gravity", verdict("named", "gravity + uptake")), CaseOutcome::wrong);
  EXPECT_EQ(named("gravity", verdict("none")), CaseOutcome::missed);
  EXPECT_EQ(named("gravity", verdict("unnamed")), CaseOutcome::missed);
}

TEST(CaseOutcome, IsInClassWhereOneIsDeclared) {
  EXPECT_EQ(named("gravity", verdict("ambiguous", "gravity", {"uptake"})), CaseOutcome::in_class);
  EXPECT_EQ(named("gravity", verdict("ambiguous", "uptake", {"gravity"})), CaseOutcome::in_class);
  EXPECT_EQ(named("gravity", verdict("ambiguous", "uptake", {"exchange"})), CaseOutcome::wrong);
  EXPECT_EQ(
      named("gravity + uptake", verdict("ambiguous", "exchange + gravity", {"uptake + gravity"})),
      CaseOutcome::in_class);
}

TEST(CaseOutcome, MissesAPartOfWhatIsHidden) {
  EXPECT_EQ(named("gravity + uptake", verdict("named", "uptake")), CaseOutcome::missed);
  EXPECT_EQ(named("gravity + uptake", verdict("named", "exchange")), CaseOutcome::wrong);
}

TEST(CaseOutcome, OfNothingHiddenIsNone) {
  const auto of = [](const Json& v) { return outcome_of(Aim::nothing, "", v); };
  EXPECT_EQ(of(verdict("none")), CaseOutcome::right);
  EXPECT_EQ(of(verdict("unnamed")), CaseOutcome::wrong);
  EXPECT_EQ(of(verdict("named", "gravity")), CaseOutcome::wrong);
  EXPECT_EQ(of(verdict("below-solver-resolution")), CaseOutcome::missed);
}

TEST(CaseOutcome, OfWhatIsNotLookedForIsUnnamed) {
  const auto of = [](const Json& v) { return outcome_of(Aim::unnamed, "gravity", v); };
  EXPECT_EQ(of(verdict("unnamed")), CaseOutcome::right);
  EXPECT_EQ(of(verdict("none")), CaseOutcome::missed);
  EXPECT_EQ(of(verdict("ambiguous", "uptake", {"exchange"})), CaseOutcome::wrong);
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
  Json found = verdict("named", "uptake");
  found["parameters"]["uptake.rate"] = {{"value", 0.9 * rate}, {"sigma", 0.05 * rate}};
  const auto error = strength_error(truth, units, found);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->relative, 0.1, 1e-9);
  EXPECT_NEAR(error->deviations, -2, 1e-9);
  found["effect"] = nullptr;  // it only comes closest
  EXPECT_FALSE(strength_error(truth, units, found));
  found = verdict("named", "exchange");
  found["parameters"] = Json::object();
  EXPECT_FALSE(strength_error(truth, units, found));
  truth.effects.clear();
  EXPECT_FALSE(strength_error(truth, units, found));
}

// Where sizing stopped the search has to stop, too: that it does is no success.
TEST(StrengthError, IsNoneAtTheEndOfARange) {
  const auto of_truth = [](double strength) {
    Json found = verdict("named", "mobility-contrast");
    found["parameters"]["mobility-contrast.strength"] = {{"value", 1.0}, {"sigma", 0.1}};
    return strength_error({{{"mobility-contrast", {strength}}}, 1, 0.03}, {}, found);
  };
  EXPECT_TRUE(of_truth(0.9));
  EXPECT_FALSE(of_truth(1));
  EXPECT_FALSE(of_truth(-1));
}

}  // namespace
}  // namespace traceraft
