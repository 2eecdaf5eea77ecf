// Curves of an effect at several strengths, and fits to them.
#include "verification/likelihood/ensemble_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/law_vesicles.hpp"
#include "verification/likelihood/ensemble_likelihood.hpp"
#include "verification/selection/series/series_size.hpp"

namespace traceraft::selection {
using namespace law_vesicles;
using likelihood::EnsembleModel;
using likelihood::RunCurves;
using observations::Quantity;
namespace {

constexpr double kLnT = 3;

// Fractions that grow with the square of the strength; perimeters that reach a plateau.
SeriesCandidate family() {
  SeriesCandidate result{"flow", {}, false};
  for (int k = 1; k <= 5; ++k) {
    const double strength = 0.3 * std::exp(k - 1.0);
    result.levels.push_back({strength, ensemble({-1 / 3.0, strength, 0.002 * k * k})});
  }
  return result;
}

class EnsembleModelTest : public ::testing::Test {
 protected:
  const std::vector<SeriesCandidate> effects{family(), candidates()[0]};
  const SeriesCurves curves{SeriesSamples(ensemble({}), effects), effects};
  const EnsembleModel several = curves.with(0), one = curves.with(1);
};

TEST_F(EnsembleModelTest, OneLevelIsLinearAlsoBeyondIt) {
  EXPECT_EQ(one.least_amplitude(), -likelihood::kLargestAmplitude);
  const double none = curves.base.mean(Quantity::fraction, kLnT),
               response = curves.level(1, 0).mean(Quantity::fraction, kLnT) - none;
  ASSERT_GT(response, 0.05);
  for (const double a : {-1.5, 0.0, 0.7, 1.0, 2.0}) {
    EXPECT_NEAR(one.at(a).mean(Quantity::fraction, kLnT), none + a * response, 1e-12) << a;
    EXPECT_NEAR(one.by_amplitude(a).mean(Quantity::fraction, kLnT), response, 1e-12) << a;
    EXPECT_EQ(one.at(a).variance(Quantity::perimeter, kLnT),
              curves.base.variance(Quantity::perimeter, kLnT));
  }
}

TEST_F(EnsembleModelTest, SeveralLevelsAreMet) {
  EXPECT_EQ(several.least_amplitude(), 0);
  EXPECT_EQ(several.largest_amplitude(), 5);
  for (std::size_t k = 0; k < 5; ++k)
    for (const Quantity quantity : observations::kQuantities)
      EXPECT_NEAR(several.at(static_cast<double>(k) + 1).mean(quantity, kLnT),
                  curves.level(0, k).mean(quantity, kLnT), 1e-12);
}

// Variances of few runs jump from level to level, here between 1 and 3.
TEST_F(EnsembleModelTest, ScatterIsAMeanOverNeighbours) {
  std::vector<RunCurves> values;
  for (int k = 0; k <= 12; ++k) {
    likelihood::RunScatter scatter{{}, {0.5, 0.5, 0.5}};
    for (auto& own : scatter.variance) own.assign(3, k % 2 == 0 ? 1 : 3);
    values.emplace_back(std::vector<double>{1, 10, 100}, scatter.variance, scatter, 1000000);
  }
  std::vector<const RunCurves*> levels;
  for (std::size_t k = 1; k < values.size(); ++k) levels.push_back(&values[k]);
  const EnsembleModel model(&values[0], levels);
  for (const double a : {4.0, 6.5, 7.3, 9.0})
    EXPECT_NEAR(model.at(a).variance(Quantity::rafts, 1), 2, 0.01) << a;
  const double alike = several.at(2.5).variance(Quantity::perimeter, kLnT);
  EXPECT_NEAR(alike, curves.level(0, 2).variance(Quantity::perimeter, kLnT), 0.1 * alike);
}

TEST_F(EnsembleModelTest, DerivativeIsContinuousAndThatOfTheCurves) {
  constexpr double kStep = 1e-5;
  for (const double a : {0.4, 1.0, 2.0, 2.3, 4.9}) {
    const double slope = several.by_amplitude(a).mean(Quantity::perimeter, kLnT);
    const double above = several.at(a + kStep).mean(Quantity::perimeter, kLnT),
                 here = several.at(a).mean(Quantity::perimeter, kLnT),
                 below = several.at(a - kStep).mean(Quantity::perimeter, kLnT);
    EXPECT_NEAR((above - here) / kStep, slope, 1e-4) << a;
    EXPECT_NEAR((here - below) / kStep, slope, 1e-4) << a;
  }
}

// A parabola through the levels is met between them, but for the intervals at both ends.
TEST_F(EnsembleModelTest, IsExactForParabolas) {
  std::vector<RunCurves> values;
  for (int k = 0; k <= 4; ++k) {
    likelihood::QuantityCurves mean;
    for (auto& own : mean) own.assign(3, k * k - 0.5 * k);
    values.emplace_back(std::vector<double>{1, 10, 100}, mean,
                        likelihood::RunScatter{mean, {0.5, 0.5, 0.5}}, 4);
  }
  const EnsembleModel model(&values[0], {&values[1], &values[2], &values[3], &values[4]});
  for (const double a : {1.2, 2.0, 2.7})
    EXPECT_NEAR(model.at(a).mean(Quantity::rafts, 1), a * a - 0.5 * a, 1e-12) << a;
}

// Scoring needs the gradient, which goes through the scatter of runs as well.
TEST_F(EnsembleModelTest, GradientOfTheDevianceIsThatOfDifferences) {
  const auto blocks = likelihood::observed_series(measured({-1 / 3.0, 1, 0.02}, 6, 0.1, 2));
  const likelihood::UnitPrior unit = likelihood::UnitPrior::within_factor(1, 8);
  const likelihood::EnsembleLikelihood likelihood(blocks, several, unit);
  const likelihood::FreeParameters free(blocks, several, unit);
  likelihood::EnsembleFit at;
  at.ln_unit = 0.5;
  at.amplitude = 2.4;
  at.scatter.vesicle.fill(0.1);
  at.scatter.look.fill(0.1);
  const Vec gradient = likelihood.expand(at, free.all).gradient, x = free.get(at);
  constexpr double kStep = 1e-5;
  for (Eigen::Index p = 0; p < 2; ++p) {
    const auto deviance = [&](double change) {
      likelihood::EnsembleFit moved = at;
      free.set(x + change * Vec::Unit(x.size(), p), moved);
      return likelihood.deviance(moved);
    };
    EXPECT_NEAR(gradient[p], (deviance(kStep) - deviance(-kStep)) / (2 * kStep),
                1e-4 * std::fabs(gradient[p]) + 1e-3)
        << p;
  }
}

// From a fit without the effect, three levels away.
TEST_F(EnsembleModelTest, FitFindsAStrongEffect) {
  const double strength = effects[0].strength_at(3.4);
  const auto blocks =
      likelihood::observed_series(measured({-1 / 3.0, strength, 0.002 * 3.4 * 3.4}, 20, 0.03, 3));
  const likelihood::UnitPrior unit = likelihood::UnitPrior::within_factor(1, 8);
  const likelihood::EnsembleFit base = likelihood::fit_ensemble(blocks, {&curves.base}, unit);
  const likelihood::EnsembleFit fit = likelihood::fit_ensemble(blocks, several, unit, base);
  EXPECT_NEAR(std::exp(fit.ln_unit), 3, 0.4);
  EXPECT_NEAR(effects[0].strength_at(fit.amplitude), strength, 4 * effects[0].deviation(fit));
  EXPECT_LT(effects[0].deviation(fit), 0.2 * strength);
}

TEST_F(EnsembleModelTest, StrengthIsLinearAndThenExponential) {
  const SeriesCandidate& effect = effects[0];
  EXPECT_NEAR(effect.strength_at(0.5), 0.15, 1e-12);
  for (int k = 1; k <= 5; ++k)
    EXPECT_NEAR(effect.strength_at(k), effect.levels[static_cast<std::size_t>(k - 1)].strength,
                1e-12);
  EXPECT_NEAR(effect.strength_at(2.5), 0.3 * std::exp(1.5), 1e-12);
  for (const double a : {0.5, 1.0, 2.5})
    EXPECT_NEAR(effect.slope_at(a),
                (effect.strength_at(a + 1e-6) - effect.strength_at(a - 1e-6)) / 2e-6, 1e-5);
}

// A rate in 1/s is known better than its two factors if their errors cancel.
TEST_F(EnsembleModelTest, RatesHaveTheErrorOfTheUnitToo) {
  likelihood::EnsembleFit fit;
  fit.amplitude = 1.5;
  fit.deviation = 0.2;
  fit.covariance << 0.01, 0.015, 0.015, 0.04;
  SeriesCandidate uptake = effects[1];
  EXPECT_NEAR(uptake.deviation(fit), 2 * 0.2, 1e-12);
  uptake.rate = true;  // d(a/u) u = da − a d ln u
  EXPECT_NEAR(uptake.deviation(fit), 2 * std::sqrt(0.04 + 1.5 * 1.5 * 0.01 - 2 * 1.5 * 0.015),
              1e-12);
}

TEST(SeriesSize, IsTheChangeOfLogarithms) {
  const auto runs = [](double factor) {
    std::vector<observations::History> all = ensemble({});
    for (observations::History& run : all)
      for (double& value : run.of(Quantity::fraction)) value *= factor;
    return all;
  };
  EXPECT_NEAR(series_change(runs(1), runs(1.2), {2, 500}), std::log(1.2) / std::sqrt(3.0), 1e-12);
}

}  // namespace
}  // namespace traceraft::selection
