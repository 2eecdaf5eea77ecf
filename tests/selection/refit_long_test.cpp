// Refits on a small vesicle, measured with little noise on a mesh that resolves it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kernel/core/error.hpp"
#include "tests/support/small_vesicle.hpp"
#include "verification/assimilation/filter/gaps.hpp"
#include "verification/assimilation/filter/random_motion.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/fit/refit.hpp"

namespace traceraft::selection {
namespace {

constexpr int kCells = 13;

BlindRequest request() {
  return testing::small_vesicle(3);
}

// From one look to the next an uptake is hardly to be told from a zero that the first one lacks:
// here that one is right.
assimilation::FilterSettings settings() {
  assimilation::FilterSettings few;
  few.first_gain = few.first_offset = 0;
  few.rank = 60;
  few.replicates = 0;
  return few;
}

assimilation::FilterProblems problems(const std::vector<assimilation::FieldSeries>& vesicles,
                                      const assimilation::FilterSettings& how = settings()) {
  return assimilation::make_filter_problems(vesicles, geometry::make_surface("sphere"),
                                            request().base, kCells, 2, true, how);
}

class RefitTest : public ::testing::Test {
 protected:
  // The base model with uptake of the given rate.
  assimilation::FilterModel model(double rate) const {
    assimilation::FilterModel result{request().base, 1, {}, {}};
    result.hypothesis.parts = {{assimilation::find_candidate("uptake").value(), {rate}}};
    return result;
  }
  static const BlindCase& drawn() {
    static const BlindCase drawn = draw_blind_case(request());
    return drawn;
  }
  double truth() const { return drawn().truth[0].values[0]; }
};

TEST_F(RefitTest, FindsTheMostProbableRate) {
  const assimilation::FilterProblems data = problems(drawn().vesicles);
  std::vector<assimilation::ErrorMaps> maps;
  (void)assimilation::filter_fields(data, model(0), settings(), maps);
  // A rate depends on the unit of time, R²/D, which these data hardly know.
  const auto rate_of = [](const Refit& fit) {
    return fit.diffusion_ratio * fit.hypothesis.parts[0].coefficients[0];
  };
  const Refit best = refit(data, model(0), settings(), maps);
  ASSERT_EQ(best.failure, "");
  EXPECT_TRUE(best.settled);
  const double sigma = best.diffusion_ratio * std::sqrt(best.covariance(0, 0));
  EXPECT_NEAR(rate_of(best), truth(), 4 * sigma);
  EXPECT_LT(sigma, 0.1 * std::fabs(truth()));
  // From elsewhere to the same place, which is as probable.
  const Refit other = refit(data, model(2 * truth()), settings(), maps);
  EXPECT_NEAR(rate_of(other), rate_of(best), 0.3 * sigma);
  EXPECT_NEAR(other.deviance, best.deviance, 0.3);
  // Without the effect they are less so, by about what the estimate says.
  assimilation::FilterModel none = model(0);
  none.hypothesis.parts.clear();
  const Refit base = refit(data, none, settings(), maps);
  EXPECT_GT(base.deviance, best.deviance + 100);
  EXPECT_GT(base.gap.train, best.gap.train);
}

// Another D makes up for most of what a bulk mobility does: the way to the best fit is a curved
// valley, and what first orders say of it lies far beside. Whichever way it starts, it is no worse
// than without the effect, and finds the truth within its error.
TEST(BulkMobility, IsRefittedAlongTheValleyOfTheDiffusionRatio) {
  BlindRequest asked = request();
  asked.effects = {"bulk-mobility"};
  asked.gap = 0.12;
  const BlindCase drawn = draw_blind_case(asked);
  const assimilation::FilterProblems data = problems(drawn.vesicles);
  std::vector<assimilation::ErrorMaps> maps;
  assimilation::FilterModel model{asked.base, 1, {}, {}};
  (void)assimilation::filter_fields(data, model, settings(), maps);
  const Refit base = refit(data, model, settings(), maps);
  model.diffusion_ratio = base.diffusion_ratio;
  const double truth = drawn.truth[0].values[0];
  for (const double start : {0.1, 3 * truth}) {
    model.hypothesis.parts = {{assimilation::find_candidate("bulk-mobility").value(), {start}}};
    const Refit fit = refit(data, model, settings(), maps);
    ASSERT_EQ(fit.failure, "");
    EXPECT_LT(fit.deviance, base.deviance) << start;
    EXPECT_NEAR(fit.hypothesis.parts[0].coefficients[0], truth, 3 * std::sqrt(fit.covariance(0, 0)))
        << start;
  }
}

// D is not known, or known as well as these data know it, or known to be the model's.
TEST(FieldFilter, TakesDAsFarAsItIsKnown) {
  BlindRequest asked = testing::small_vesicle(4);
  asked.first = 2;
  asked.effects.clear();
  asked.diffusion_ratio = 1.15;
  assimilation::FilterSettings how = settings();
  how.replicates = 99;
  const assimilation::FilterProblems data = problems(draw_blind_case(asked).vesicles, how);
  const auto found = [&](double doubt) {
    how.diffusion_ratio_doubt = doubt;
    std::vector<assimilation::ErrorMaps> maps;
    assimilation::FilterModel model{asked.base, 1, {}, {}};
    Refit fit = refit(data, model, how, maps);
    model.diffusion_ratio = fit.diffusion_ratio;
    bootstrap(assimilation::filter_fields(data, model, how, maps), model, fit);
    return fit;
  };
  const Refit free = found(std::numeric_limits<double>::infinity());
  const double doubt = free.diffusion_ratio_deviation,
               diffusion_ratio = std::log(free.diffusion_ratio);
  EXPECT_NEAR(diffusion_ratio, std::log(asked.diffusion_ratio), 4 * doubt);
  const Refit half = found(doubt);
  EXPECT_NEAR(std::log(half.diffusion_ratio), diffusion_ratio / 2, 0.1 * diffusion_ratio);
  EXPECT_NEAR(half.diffusion_ratio_deviation, doubt / std::sqrt(2), 0.2 * doubt);
  EXPECT_NEAR(half.deviance - free.deviance, std::pow(diffusion_ratio / doubt, 2) / 2,
              0.1 * std::pow(diffusion_ratio / doubt, 2));
  const Refit fixed = found(1e-5);
  EXPECT_NEAR(fixed.diffusion_ratio, 1, 1e-4);
  EXPECT_NEAR(fixed.diffusion_ratio_deviation, 1e-5, 3e-6);
}

// A rate that no forecast survives, however often it is halved.
TEST_F(RefitTest, SaysWhyThereIsNone) {
  const assimilation::FilterProblems data = problems(drawn().vesicles);
  std::vector<assimilation::ErrorMaps> maps;
  (void)assimilation::filter_fields(data, model(0), settings(), maps);
  EXPECT_NE(refit(data, model(std::nan("")), settings(), maps).failure, "");
}

// Against differences, where the model itself changes in time.
TEST_F(RefitTest, KnowsWhatTheDiffusionRatioDoesBesideCooling) {
  const assimilation::FilterProblems data = problems(drawn().vesicles);
  assimilation::FilterModel model{request().base, 1, {}, {}};
  model.hypothesis.parts = {{assimilation::find_candidate("cooling").value(), {0.1}}};
  std::vector<assimilation::ErrorMaps> maps;
  const assimilation::FilterResult here =
      assimilation::filter_fields(data, model, settings(), maps);
  constexpr double kStep = 0.01;
  const auto forecast_at = [&](double diffusion_ratio) {
    assimilation::FilterModel other = model;
    other.diffusion_ratio = diffusion_ratio;
    std::vector<assimilation::ErrorMaps> same = maps;
    const assimilation::Innovation in =
        assimilation::filter_fields(data, other, settings(), same).innovations[0];
    return Vec(in.forecast.cwiseQuotient(in.noise));
  };
  const Vec difference =
      (forecast_at(std::exp(kStep)) - forecast_at(std::exp(-kStep))) / (2 * kStep);
  const Vec derivative = here.innovations[0].parameters.col(assimilation::kDiffusionRatio);
  EXPECT_LT((derivative - difference).norm(), 0.03 * difference.norm());
}

// Four snapshots, the last of which is held out.
std::vector<assimilation::FieldSeries> four_snapshots() {
  BlindRequest asked = request();
  asked.snapshots = 4;
  return draw_blind_case(asked).vesicles;
}

TEST(Filter, DoesNotLookAtWhatIsHeldOut) {
  std::vector<assimilation::FieldSeries> vesicles = four_snapshots();
  assimilation::FilterSettings few = settings();
  few.replicates = 5;
  const assimilation::FilterModel model{request().base, 1, {}, assimilation::candidates()};
  const auto pass_of = [&](const std::vector<assimilation::FieldSeries>& measured) {
    std::vector<assimilation::ErrorMaps> maps;
    assimilation::FilterProblems data = problems(measured, few);
    assimilation::set_random_effects(assimilation::candidates(), model.base, data);
    return assimilation::filter_fields(data, model, few, maps);
  };
  const assimilation::FilterResult before = pass_of(vesicles);
  vesicles[0].snapshots[3].values.array() += 0.05;
  const assimilation::FilterResult after = pass_of(vesicles);
  EXPECT_EQ(before.deviance, after.deviance);
  EXPECT_EQ(before.score, after.score);
  EXPECT_EQ(before.information, after.information);
  EXPECT_EQ(before.null_scores, after.null_scores);
  EXPECT_NE(before.innovations[2].values, after.innovations[2].values);
  EXPECT_TRUE(after.innovations[2].held_out);
  EXPECT_EQ(after.gap_parts.size(), 2u);
  EXPECT_EQ(after.heldout_gap_parts.size(), 1u);
  EXPECT_EQ(before.gap_parts[1], after.gap_parts[1]);
}

// The scores of noise have the information as their covariance where the model is right.
TEST(Filter, KnowsHowScoresOfNoiseScatter) {
  assimilation::FilterSettings many = settings();
  many.first_gain = many.first_offset = assimilation::FilterSettings().first_gain;
  many.replicates = 199;
  assimilation::FilterModel model{
      request().base, 1, {}, {assimilation::find_candidate("gravity").value()}};
  BlindRequest asked = request();
  asked.effects.clear();
  const assimilation::FilterProblems data = problems(draw_blind_case(asked).vesicles, many);
  std::vector<assimilation::ErrorMaps> maps;
  const assimilation::FilterResult pass = assimilation::filter_fields(data, model, many, maps);
  for (const Eigen::Index k : {assimilation::kDiffusionRatio, assimilation::kFirstParameter}) {
    const double variance = pass.null_scores.row(k).squaredNorm() / many.replicates;
    EXPECT_NEAR(variance / pass.information(k, k), 1, 0.3) << k;
  }
}

TEST_F(RefitTest, GoesWithoutOutliers) {
  std::vector<assimilation::FieldSeries> spoilt = drawn().vesicles;
  assimilation::FieldSnapshot& snapshot = spoilt[0].snapshots[1];
  for (int k = 0; k < 1000; k += 100) snapshot.values[k] = k % 200 == 0 ? 3 : -2;
  const assimilation::FilterProblems clean = problems(drawn().vesicles), data = problems(spoilt);
  EXPECT_EQ(clean[0].outliers, 0u);
  EXPECT_GE(data[0].outliers, 10u);
  EXPECT_LE(data[0].outliers, 12u);
  EXPECT_NEAR(data[0].noise[0], clean[0].noise[0], 0.05 * clean[0].noise[0]);
  for (int k = 0; k < 1000; k += 6) snapshot.values[k] = k % 4 == 0 ? 3 : -2;
  EXPECT_THROW((void)problems(spoilt), InputError);
}

TEST_F(RefitTest, SaysWhichPlaceIsOffTheSurface) {
  std::vector<assimilation::FieldSeries> moved = drawn().vesicles;
  moved[0].snapshots[1].points[3] *= 1.2;
  try {
    (void)problems(moved);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("snapshot 2"), std::string::npos) << error.what();
  }
}

// Images of stated blur are as far from the forecasts as noise is; images of unstated blur are
// further.
TEST(FieldFilter, AllowsForBlurThatIsStated) {
  BlindRequest asked = request();
  asked.effects.clear();
  asked.blur = 0.15;
  const std::vector<assimilation::FieldSeries> vesicles = draw_blind_case(asked).vesicles;
  const auto squares = [&](double stated) {
    assimilation::FilterSettings how = settings();
    how.blur = stated;
    const assimilation::FilterProblems data = problems(vesicles, how);
    std::vector<assimilation::ErrorMaps> maps;
    const assimilation::FilterResult pass =
        assimilation::filter_fields(data, {asked.base, 1, {}, {}}, how, maps);
    double sum = 0, error = 0;
    for (const assimilation::Innovation& in : pass.innovations) {
      sum += in.gap.squaredNorm() / static_cast<double>(in.gap.size());
      error = std::max(error, in.model_error);
    }
    return std::pair(sum / static_cast<double>(pass.innovations.size()), error);
  };
  const auto [known, no_error] = squares(asked.blur);
  const auto [unknown, error] = squares(0);
  EXPECT_LT(known, 1.15);
  EXPECT_GT(unknown, known + 0.1);
  EXPECT_LT(no_error, error);
}

// Nothing depends on the unit of c: with phases at 0 and 100 the same is as far from the data, in
// units of the noise, and as probable.
TEST(FieldFilter, KnowsNoUnitOfC) {
  constexpr double kUnit = 100;
  BlindRequest asked = request();
  asked.base.mobility = physics::make_mobility("constant:value=0.25");
  asked.effects.clear();
  std::vector<assimilation::FieldSeries> vesicles = draw_blind_case(asked).vesicles;
  assimilation::FilterModel model{asked.base, 1, {}, {}};
  const auto pass_of = [&] {
    const assimilation::FilterProblems data = assimilation::make_filter_problems(
        vesicles, geometry::make_surface("sphere"), model.base, kCells, 2, true, settings());
    std::vector<assimilation::ErrorMaps> maps;
    return assimilation::filter_fields(data, model, settings(), maps);
  };
  const assimilation::FilterResult one = pass_of();
  for (assimilation::FieldSeries& vesicle : vesicles)
    for (assimilation::FieldSnapshot& snapshot : vesicle.snapshots) snapshot.values *= kUnit;
  model.base.well = {0.25 / (kUnit * kUnit), 0, kUnit};
  const assimilation::FilterResult other = pass_of();
  ASSERT_EQ(one.innovations.size(), other.innovations.size());
  for (std::size_t k = 0; k < one.innovations.size(); ++k) {
    EXPECT_NEAR(other.innovations[k].weighted_squares, one.innovations[k].weighted_squares,
                0.01 * one.innovations[k].weighted_squares);
    EXPECT_EQ(other.innovations[k].model_error, one.innovations[k].model_error);
  }
}

// Whoever calibrates images knows c up to a zero and a scale, of the first one, too: what the model
// would make of them is no gap.
TEST(FieldFilter, AllowsForAZeroAndAScaleThatAllSnapshotsShare) {
  BlindRequest asked = request();
  asked.effects.clear();
  const std::vector<assimilation::FieldSeries> right = draw_blind_case(asked).vesicles;
  const assimilation::FilterModel model{asked.base, 1, {}, {}};
  const auto pass_of = [&](double gain, double offset) {
    assimilation::FilterSettings how = settings();
    how.first_gain = how.first_offset = assimilation::FilterSettings().first_gain;
    std::vector<assimilation::FieldSeries> vesicles = right;
    for (assimilation::FieldSnapshot& snapshot : vesicles[0].snapshots)
      snapshot.values = (1 + gain) * snapshot.values.array() + offset;
    assimilation::FilterProblems data = assimilation::make_filter_problems(
        vesicles, geometry::make_surface("sphere"), model.base, kCells, 2, true, how);
    std::vector<assimilation::ErrorMaps> maps;
    return assimilation::filter_fields(data, model, how, maps);
  };
  const assimilation::FilterResult without = pass_of(0, 0);
  for (const auto& [gain, offset] : {std::pair{0.0, 0.05}, std::pair{0.1, 0.0}}) {
    const assimilation::FilterResult with = pass_of(gain, offset);
    // 490 and three times the gap if the first snapshot were right as it is.
    EXPECT_NEAR(with.deviance, without.deviance, 50);
    EXPECT_LT(assimilation::gaps_of_pass(with).train,
              1.15 * assimilation::expected_gaps(with).train);
  }
}

// Measurements of a vesicle that turns by 2 rad between looks are as probable.
TEST(FieldFilter, TakesATurnAlong) {
  BlindRequest asked = testing::small_vesicle(3);
  asked.effects = {};
  asked.first = 40;  // rafts are much alike from look to look
  asked.last = 48;
  std::vector<assimilation::FieldSeries> series = draw_blind_case(asked).vesicles;
  assimilation::FilterSettings settings;
  settings.rank = 30;
  settings.replicates = 0;
  const assimilation::FilterModel model{asked.base, 1, {}, {}};
  const auto pass = [&] {
    const assimilation::FilterProblems data = assimilation::make_filter_problems(
        series, geometry::make_surface("sphere"), asked.base, 12, 1, false, settings);
    std::vector<assimilation::ErrorMaps> maps;
    return std::pair(assimilation::filter_fields(data, model, settings, maps), data[0].turns);
  };
  const auto [still, none] = pass();
  const Eigen::Matrix3d Q = Eigen::AngleAxisd(2, Point(1, -2, 0.5).normalized()).toRotationMatrix();
  for (std::size_t k = 1; k < 3; ++k)
    for (Point& x : series[0].snapshots[k].points) x = (k == 1 ? Q : Eigen::Matrix3d(Q * Q)) * x;
  const auto [turned, turns] = pass();
  EXPECT_FALSE(none[1]);
  ASSERT_TRUE(turns[1]);
  // A round raft does not say by how much it turns about its middle: what was measured does.
  const double gap = assimilation::gaps_of_pass(still).train;
  EXPECT_NEAR(assimilation::gaps_of_pass(turned).train, gap, 0.03 * gap);
  const double scatter = std::sqrt(2.0 * 2 * asked.points);
  EXPECT_NEAR(turned.deviance, still.deviance, 2 * scatter);
  EXPECT_NEAR(
      turned.information(assimilation::kDiffusionRatio, assimilation::kDiffusionRatio),
      still.information(assimilation::kDiffusionRatio, assimilation::kDiffusionRatio),
      0.2 * still.information(assimilation::kDiffusionRatio, assimilation::kDiffusionRatio));
}

}  // namespace
}  // namespace traceraft::selection
