// Effects found from series, on vesicles whose curves are formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "tests/support/law_vesicles.hpp"

namespace traceraft::selection {
using namespace law_vesicles;
namespace {

TEST(SeriesExplanation, NamesTheClassOfWhatIsMissing) {
  const SeriesExplanation found = explained(measured({-1 / 3.0, 0, 0.05}, 15, 0.05, 2));
  EXPECT_LE(found.p, 0.02);
  EXPECT_EQ(found.finding, Finding::ambiguous);  // one class of two effects
  ASSERT_EQ(found.named.size(), 1u);
  EXPECT_EQ(found.named[0], (std::vector<std::string>{"uptake", "cooling"}));
  EXPECT_NEAR(std::exp(found.base.ln_unit), 2, 0.5);
  const auto score = std::find_if(found.scores.begin(), found.scores.end(),
                                  [](const SeriesScore& s) { return s.effect == "uptake"; });
  EXPECT_LT(score->low, 2);
  EXPECT_GT(score->high, 2);
  EXPECT_EQ(score->telling, observations::Quantity::fraction);
  EXPECT_LT(score->vesicles, 15);
}

TEST(SeriesExplanation, NamesASingleEffectThatNothingElseIsLike) {
  const SeriesExplanation found = explained(measured({-1 / 3.0, 2, 0}, 15, 0.05, 1));
  EXPECT_EQ(found.finding, Finding::named);
  EXPECT_EQ(found.named[0], std::vector<std::string>{"ohta-kawasaki"});
}

TEST(SeriesExplanation, NamesNothingWhereNothingIsMissing) {
  const SeriesExplanation found = explained(measured({}, 15, 0.05, 1));
  EXPECT_EQ(found.finding, Finding::none);
  EXPECT_GT(found.p, 0.05);
  EXPECT_TRUE(found.named.empty());
}

// Zero has no logarithm, and a stated error of it adds nothing.
TEST(SeriesExplanation, LooksWithoutRaftsSayNothing) {
  observations::MeasuredVesicles data = measured({}, 10, 0.05, 1);
  const auto rafts = static_cast<std::size_t>(observations::Quantity::rafts);
  data.measurements.back().values[rafts].reset();
  const SeriesExplanation without = explained(data);
  data.measurements.back().values[rafts] = 0;
  data.measurements.back().sigma[rafts] = 0.5;
  const SeriesExplanation none = explained(data);
  EXPECT_EQ(none.p, without.p);
  EXPECT_EQ(none.trend_p, without.trend_p);
  EXPECT_EQ(none.base.deviance, without.base.deviance);
}

// Beyond the end of the runs nothing is known of them.
TEST(SeriesExplanation, StaysWithinTheRuns) {
  const SeriesExplanation found = explained(measured({}, 15, 0.05, 0.2));
  EXPECT_GT(std::exp(found.base.ln_unit), 0.15);
  // At the same times, of vesicles three times as fast.
  observations::MeasuredVesicles fast = measured({}, 15, 0.05, 1);
  for (observations::Measurement& m : fast.measurements) {
    const observations::History run = vesicle({}, 3);
    for (const observations::Quantity quantity : observations::kQuantities)
      m.values[observations::index_of(quantity)] = run.at(quantity, std::min(1000.0, 3 * m.time));
  }
  EXPECT_GT(std::exp(explained(fast).base.ln_unit), 0.6);
  for (observations::Measurement& m : fast.measurements) m.time *= 20;
  EXPECT_THROW(explained(fast), InputError);
}

TEST(SeriesExplanation, AdmitsATrendThatNothingExplains) {
  const SeriesExplanation found = explained(measured({-0.6, 0, 0}, 15, 0.05, 1));
  EXPECT_EQ(found.finding, Finding::unnamed);
  EXPECT_LE(found.trend_p, 0.02);
  // The trend: perimeters fall faster than t^(-1/3), and soon one raft is left.
  ASSERT_EQ(found.offsets.size(), 3u);
  EXPECT_EQ(found.offsets[0].quantity, observations::Quantity::perimeter);
  EXPECT_NEAR(found.offsets[0].slope, -0.6 + 1 / 3.0, 0.03);
  EXPECT_LT(found.offsets[0].slope_deviations, -5);
  EXPECT_LT(std::fabs(found.offsets[2].slope_deviations), 3);
}

TEST(EnsembleFit, SaysHowFarMeasurementsLieBesideIt) {
  const SeriesExplanation found = explained(measured({}, 15, 0.02, 1));
  for (const SeriesOffset& offset : found.offsets) {
    EXPECT_LT(std::fabs(offset.level), 0.1);
    EXPECT_LT(std::fabs(offset.slope), 0.02);
  }
}

// Effects that another D imitates are seen where D is known.
TEST(SeriesExplanation, SeesWhatAnotherDDoesIfDIsKnown) {
  observations::MeasuredVesicles data = measured({}, 20, 0.05, 1);
  for (observations::Measurement& m : data.measurements)  // whole numbers are not quite alike
    m.values[static_cast<std::size_t>(observations::Quantity::rafts)].reset();
  std::vector<observations::History> slower;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) slower.push_back(vesicle({}, seed, 2));
  const auto explained_with = [&](double factor) {
    SeriesRequest request{likelihood::UnitPrior::within_factor(1, factor)};
    request.replicates = 49;
    return explain_series(data, ensemble({}), {{"bulk-mobility", {{1, slower}}, true}}, request);
  };
  const SeriesExplanation unknown = explained_with(8), known = explained_with(1.05);
  EXPECT_EQ(unknown.finding, Finding::not_identifiable);
  EXPECT_TRUE(std::isinf(unknown.scores[0].vesicles));
  EXPECT_EQ(known.finding, Finding::none);
  EXPECT_LT(known.scores[0].vesicles, 20);
}

// By its logarithm, like the others.
TEST(EnsembleFit, SaysHowFarTheRaftFractionLiesBesideIt) {
  observations::MeasuredVesicles data = measured({}, 15, 0.02, 1);
  for (observations::Measurement& m : data.measurements)
    *m.values[static_cast<std::size_t>(observations::Quantity::fraction)] *= 2;
  const SeriesOffset offset = explained(data).offsets.at(2);
  EXPECT_EQ(offset.quantity, observations::Quantity::fraction);
  EXPECT_NEAR(offset.level, std::log(2.0), 0.02);
}

// An effect is seen in nine cases of ten, at the ensemble's strength, if that is four standard
// deviations: bounds shrink with the square root of the number of vesicles.
TEST(SeriesExplanation, CountsVesiclesByTheBoundsOfTheirEffect) {
  const SeriesExplanation found = explained(measured({}, 15, 0.05, 1));
  const auto drawn = candidates();
  for (const SeriesScore& score : found.scores) {
    const auto candidate = std::find_if(drawn.begin(), drawn.end(), [&](const auto& c) {
      return c.effect == score.effect && c.two_sided;
    });
    if (candidate == drawn.end()) continue;
    const double deviation = (score.high - score.low) / 2 / 1.96 / candidate->levels[0].strength;
    ASSERT_TRUE(std::isfinite(score.vesicles)) << score.effect;
    EXPECT_NEAR(score.vesicles, 15 * 16 * deviation * deviation, 0.25 * score.vesicles)
        << score.effect;
  }
}

// Classes that are nearly as probable as the best one are named with what would tell them apart.
TEST(SeriesExplanation, SaysWhatWouldTellClassesApart) {
  constexpr int kVesicles = 8, kMore = 20;
  std::vector<SeriesCandidate> two = {candidates()[0]};  // a drift of the fraction
  two.push_back({"cooling", {{1, ensemble({-1 / 3.0, 0.6, 0.05})}}, true});  // and a plateau
  SeriesRequest request{likelihood::UnitPrior::within_factor(1, 8)};
  request.replicates = 99;
  const auto explain = [&](const RaftLaw& law, int vesicles) {
    return explain_series(measured(law, vesicles, 0.1, 1), ensemble({}), two, request);
  };
  const SeriesExplanation found = explain({-1 / 3.0, 0.35, 0.05}, kVesicles);  // between both
  EXPECT_EQ(found.finding, Finding::ambiguous);
  ASSERT_EQ(found.named.size(), 2u);
  EXPECT_EQ(found.named[0].front(), "cooling");
  ASSERT_EQ(found.ties.size(), 1u);
  const SeriesTie& tie = found.ties.front();
  EXPECT_EQ(tie.effect, "cooling");
  EXPECT_EQ(tie.other, "uptake");
  EXPECT_NE(tie.telling, observations::Quantity::fraction);
  // These do not tell them apart, more of one of them do.
  EXPECT_GT(tie.vesicles, kVesicles);
  EXPECT_LT(tie.vesicles, kMore);
  const SeriesExplanation told = explain({-1 / 3.0, 0.6, 0.05}, kMore);
  EXPECT_EQ(told.finding, Finding::named);
  EXPECT_EQ(told.named[0], std::vector<std::string>{"cooling"});
}

// An effect that was simulated at several strengths, of which the true one is between two.
TEST(SeriesExplanation, FindsTheStrengthAmongLevels) {
  SeriesCandidate flow{"flow", {}, false};
  for (const double strength : {0.5, 1.5, 4.0})
    flow.levels.push_back({strength, ensemble({-1 / 3.0, strength, 0})});
  flow.typical = 1;
  const std::vector<SeriesCandidate> two{flow, candidates()[0]};
  SeriesRequest request{likelihood::UnitPrior::within_factor(1, 8)};
  request.replicates = 99;
  const auto explain = [&](const RaftLaw& law) {
    return explain_series(measured(law, 15, 0.1, 2), ensemble({}), two, request);
  };
  const SeriesExplanation found = explain({-1 / 3.0, 2.5, 0});
  EXPECT_EQ(found.finding, Finding::named);
  EXPECT_EQ(found.scores[0].effect, "flow");
  EXPECT_LT(found.scores[0].low, 2.5);
  EXPECT_GT(found.scores[0].high, 2.5);
  EXPECT_LT(found.scores[0].high, 2 * found.scores[0].low);
  EXPECT_NEAR(std::exp(found.scores[0].ln_unit), 2, 0.6);
  EXPECT_EQ(explain({}).finding, Finding::none);
}

// Vesicles whose effect is as if D were another: D may be that of the model without it, too.
TEST(SeriesExplanation, RangeOfDHoldsWhatAnEffectMayDo) {
  observations::MeasuredVesicles data = measured({}, 20, 0.05, 1);
  auto& looks = data.measurements;  // early ones, which all runs cover
  looks.erase(
      std::remove_if(looks.begin(), looks.end(), [](const auto& m) { return m.time > 100; }),
      looks.end());
  std::vector<observations::History> faster;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) faster.push_back(vesicle({}, seed, 0.5));
  const auto range_with = [&](const SeriesCandidate& candidate) {
    SeriesRequest request{likelihood::UnitPrior::within_factor(1, 8)};
    request.replicates = 49;
    return explain_series(data, ensemble({}), {candidate}, request).unit_range;
  };
  const UnitRange confounded = range_with({"bulk-mobility", {{1, faster}}, false}),
                  clear = range_with(candidates()[0]);
  for (const UnitRange& range : {confounded, clear}) {
    EXPECT_LT(range.low, 0);
    EXPECT_GT(range.high, 0);
  }
  // Twice as fast at a strength of 1; beyond, whole numbers of rafts tell the difference.
  EXPECT_GT(confounded.high, std::log(2.0));
  EXPECT_EQ(confounded.high_by, "bulk-mobility");
  EXPECT_LT(clear.high, 0.7 * std::log(2.0));
  EXPECT_GT(confounded.low, clear.low - 0.1);
}

}  // namespace
}  // namespace traceraft::selection
