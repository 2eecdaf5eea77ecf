// Calibration against a simulator that costs nothing.
#include "verification/calibration/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/error.hpp"
#include "tests/support/simulated_rafts.hpp"
#include "verification/calibration/calibration_data.hpp"
#include "verification/calibration/local_regression.hpp"
#include "verification/likelihood/ensemble_likelihood.hpp"
#include "verification/selection/series/series_explanation.hpp"

namespace traceraft::observations {
using namespace simulated_rafts;
namespace {

TEST(Calibration, SaysWhereItsSearchEnds) {
  const std::vector<calibration::CalibrationPoint> points = {
      {{}, simulate(kEpsilon, true, 40, 77)}};
  const MeasuredVesicles data = measured(true, 1);
  EXPECT_EQ(calibration::calibrate(data, {}, points, around(kSeconds)).at_bound, 0);
  const likelihood::UnitPrior fast =
      likelihood::UnitPrior::uniform(kSeconds / 8, {kSeconds / 16, kSeconds / 4});
  const calibration::Calibration found = calibration::calibrate(data, {}, points, fast);
  EXPECT_EQ(found.at_bound, 1);
  EXPECT_FALSE(found.parameters[0].determined);
}

// Any D is as good as a larger one for late looks at a number of rafts that no longer changes.
TEST(Calibration, KnowsNoUnitWhereCurvesAreFlat) {
  std::vector<History> runs = simulate(kEpsilon, true, 20, 77);
  for (History& run : runs)
    for (std::size_t i = 0; i < run.time.size(); ++i)
      if (run.time[i] > 100)
        for (const Quantity quantity : kQuantities) run.of(quantity)[i] = run.of(quantity)[i - 1];
  std::vector<History> vesicles = runs;
  for (History& vesicle : vesicles)
    for (double& t : vesicle.time) t *= kSeconds;
  PublishedFacts late = design();
  late.window = {1000 * kSeconds, 2000 * kSeconds};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const MeasuredVesicles data = draw_from_runs(late, vesicles, 5, seed);
    const calibration::Calibration found =
        calibration::calibrate(data, {}, {{{}, runs}}, around(kSeconds));
    const calibration::CalibratedParameter& unit = found.parameters[0];
    EXPECT_FALSE(unit.determined) << seed;
    // Looks are 1000 units after the start with the truth, and more than 100 with ten times that.
    EXPECT_LT(unit.interval.low, kSeconds / 4) << seed;
    EXPECT_GT(unit.interval.high, 4 * kSeconds) << seed;
    EXPECT_DOUBLE_EQ(found.correlation(0, 0), 1);
  }
}

// ε goes with D: if that is not found, neither is ε, however narrow its interval.
TEST(Calibration, DeterminesNothingBesideAUnitAtItsEnd) {
  std::vector<calibration::CalibrationPoint> points;
  for (const auto& ln : calibration::design_around({std::log(kEpsilon)}, 0.25))
    points.push_back({ln, simulate(std::exp(ln[0]), true, 40, 5)});
  const likelihood::UnitPrior fast =
      likelihood::UnitPrior::uniform(kSeconds / 4, {kSeconds / 16, kSeconds / 2});
  const calibration::Calibration found =
      calibration::calibrate(measured(true, 1), kSought, points, fast);
  EXPECT_TRUE(found.unit_at_bound);
  const calibration::CalibratedParameter& epsilon = found.parameters[1];
  EXPECT_LT(epsilon.interval.high, 2 * epsilon.interval.low);
  EXPECT_FALSE(epsilon.determined);
}

// An estimate stays within what is allowed of a parameter.
TEST(Calibration, StaysWithinWhatIsAllowed) {
  std::vector<calibration::CalibrationPoint> points;
  for (const auto& ln : calibration::design_around({std::log(kEpsilon)}, 0.25))
    points.push_back({ln, simulate(std::exp(ln[0]), true, 20, 5)});
  const statistics::Interval below{0.01, 0.9 * kEpsilon};
  EXPECT_LE(
      calibration::calibrate(measured(true, 1), {{"epsilon", below}}, points, around(kSeconds))
          .parameters[1]
          .value,
      below.high * 1.0001);
}

// Fractions of runs grow in time: what counts is when each vesicle was looked at.
TEST(EnsembleFit, HoldsFractionsAgainstThoseAtTheSameTimes) {
  const auto with_fraction = [](double fraction) {
    std::vector<History> runs = simulate(kEpsilon, true, 17, 5);
    for (History& run : runs)
      for (std::size_t i = 0; i < run.time.size(); ++i)
        run.of(Quantity::fraction)[i] = fraction * (1 + 0.05 * std::log(run.time[i]));
    return runs;
  };
  std::vector<History> vesicles = with_fraction(0.1);
  for (History& vesicle : vesicles)
    for (double& t : vesicle.time) t *= kSeconds;
  MeasuredVesicles data = draw_from_runs(design(), vesicles, 5, 1);
  Measurement early = data.measurements.front();
  early.time = 2 * kSeconds;
  early.values[2] = vesicles[0].at(Quantity::fraction, early.time);
  data.measurements.insert(data.measurements.begin(), early);

  const auto blocks =
      likelihood::observed_series(data, statistics::each_once(17), {Quantity::fraction});
  const auto deviance = [&](double fraction) {
    const likelihood::RunCurves curves(with_fraction(fraction));
    likelihood::EnsembleFit fit;
    fit.scatter.vesicle.fill(0.1);
    fit.scatter.look.fill(0.003);
    fit.ln_unit = std::log(kSeconds);
    const likelihood::UnitPrior unit = likelihood::UnitPrior::uniform(1, {0.001, 10});
    return likelihood::EnsembleLikelihood(blocks, {&curves}, unit).deviance(fit);
  };
  // The parabola's least, and twice its curvature: 17 vesicles tell it to a quarter of a deviation.
  const double low = deviance(0.095), here = deviance(0.1), high = deviance(0.105);
  const double best = 0.1 + 0.5 * 0.005 * (low - high) / (low - 2 * here + high);
  EXPECT_NEAR(best, 0.1, 0.002);
}

// Fractions that are all the same, as far as they were written down, still tell models apart: by
// the scatter between vesicles that it takes, ln of what they are over what is expected.
TEST(EnsembleFit, CountsFractionsThatAreAllTheSame) {
  const std::vector<History> runs = simulate(kEpsilon, true, 17, 5);
  const likelihood::RunCurves curves(runs);
  const auto deviance = [&](double fraction) {
    MeasuredVesicles data = draw_from_runs(design(), runs, 5, 1);
    for (Measurement& m : data.measurements) m.values[2] = fraction;
    return likelihood::fit_ensemble(
               likelihood::observed_series(data, statistics::each_once(17), {Quantity::fraction}),
               {&curves}, likelihood::UnitPrior::uniform(1, {0.1, 10}))
        .deviance;
  };
  EXPECT_NEAR(deviance(0.2) - deviance(0.11), 2 * 17 * std::log(std::log(2.0) / std::log(1.1)), 1);
}

// A calibration and an explanation of the same looks find the same unit of time, and the same
// scatter.
TEST(Calibration, FindsWhatAnExplanationFinds) {
  MeasuredVesicles data = measured(true, 3);
  for (Measurement& m : data.measurements) m.values[index_of(Quantity::fraction)].reset();
  const std::vector<History> runs = simulate(kEpsilon, true, 40, 77);
  selection::SeriesRequest request{likelihood::UnitPrior::within_factor(1.5 * kSeconds, 8)};
  request.replicates = 9;
  const selection::SeriesExplanation explained = selection::explain_series(
      data, runs, {{"another", {{1, simulate(1.2 * kEpsilon, true, 40, 77)}}, true}}, request);
  const likelihood::EnsembleFit found =
      calibration::calibrate(data, {}, {{{}, runs}}, request.unit).best;
  EXPECT_NEAR(found.ln_unit, explained.base.ln_unit, 1e-3);
  for (const Quantity quantity : {Quantity::perimeter, Quantity::rafts})
    EXPECT_NEAR(found.scatter_beyond_runs(quantity), explained.base.scatter_beyond_runs(quantity),
                1e-3);
}

TEST(Calibration, DeterminesNothingUnlessItConverges) {
  std::vector<calibration::CalibrationPoint> points;
  for (const auto& ln : calibration::design_around({std::log(kEpsilon)}, 0.25))
    points.push_back({ln, simulate(std::exp(ln[0]), true, 40, 5)});
  calibration::Calibration found =
      calibration::calibrate(measured(true, 1), kSought, points, around(kSeconds));
  ASSERT_TRUE(found.parameters[1].determined);
  EXPECT_TRUE(found.converged);
  calibration::mark_unconverged(found);
  EXPECT_FALSE(found.parameters[1].determined);
  EXPECT_FALSE(found.converged);
}

// Perimeters known to four tenths of what is expected: by the mean of their logarithms, which is
// 0.096 lower, they would be 1.33 times as old.
TEST(EnsembleFit, OfPerimetersIsNotPulledByErrorsThatAreAbsolute) {
  History run;
  for (double t = 1; t < 1000; t *= 1.1) {
    run.time.push_back(t);
    run.of(Quantity::perimeter).push_back(30 * std::pow(t, -1 / 3.0));
    run.of(Quantity::rafts).push_back(5);
    run.of(Quantity::fraction).push_back(0.1);
  }
  const std::vector<History> runs(3, run);
  MeasuredVesicles data;
  constexpr int kVesicles = 1000;
  std::vector<int> all;
  std::uint64_t k = 0;
  for (int v = 0; v < kVesicles; ++v) {
    double value = 0;
    while (!(value > 0)) value = 10 * (1 + 0.4 * normal(3, k++));
    data.measurements.push_back({std::to_string(v), 27, 5, {value}, {4.0}});
    all.push_back(v);
  }
  const likelihood::RunCurves curves(runs);
  const likelihood::EnsembleFit found =
      likelihood::fit_ensemble(likelihood::observed_series(data, all, {Quantity::perimeter}),
                               {&curves}, likelihood::UnitPrior::uniform(1, {0.3, 3}));
  EXPECT_NEAR(found.ln_unit, 0, 2.5 * 3 * 0.4 / std::sqrt(1.0 * kVesicles));
}

// At time zero there is the initial noise, of which the model foretells nothing.
TEST(Calibration, LeavesLooksOfTimeZeroOut) {
  const std::vector<calibration::CalibrationPoint> points = {
      {{}, simulate(kEpsilon, true, 20, 77)}};
  MeasuredVesicles data = measured(true, 1);
  const double without =
      calibration::calibrate(data, {}, points, around(kSeconds)).parameters[0].value;
  Measurement first = data.measurements.front();
  first.time = 0;
  data.measurements.insert(data.measurements.begin(), first);
  EXPECT_EQ(calibration::looks_that_tell_nothing(data), 1);
  EXPECT_EQ(calibration::calibrate(data, {}, points, around(kSeconds)).parameters[0].value,
            without);
}

TEST(Calibration, RefusesTooLittle) {
  MeasuredVesicles two = measured(true, 1);
  two.measurements.resize(7);
  EXPECT_THROW((void)calibration::calibrate(two, {}, {{{}, simulate(0.1, true, 3, 1)}}, around(1)),
               InputError);
  EXPECT_THROW((void)calibration::calibrate(measured(true, 1), kSought,
                                            {{{0}, simulate(0.1, true, 3, 1)}}, around(1)),
               InputError);
}

// A simulation far away, which the data exclude, does not decide what those nearby leave open.
TEST(Calibration, IsNotSureBecauseOfAFarPoint) {
  std::vector<calibration::CalibrationPoint> points;
  for (const double step : {0.25, 0.1})
    for (const auto& ln : calibration::design_around({std::log(kEpsilon)}, step))
      points.push_back({ln, simulate(std::exp(ln[0]), false, 40, 5)});
  points.push_back({{std::log(2.5 * kEpsilon)}, simulate(2.5 * kEpsilon, true, 40, 5)});
  const calibration::Calibration found =
      calibration::calibrate(measured(false, 1), kSought, points, around(kSeconds));
  EXPECT_GT(found.at_points.back().deviance, found.best.deviance + 30);
  EXPECT_FALSE(found.parameters[1].determined);
}

TEST(Calibration, CountsVesiclesThatShowSomething) {
  MeasuredVesicles data = measured(true, 1);
  EXPECT_EQ(calibration::looks_that_tell_nothing(data), 0);
  const auto vesicles = data.vesicles();
  const auto leave = [&](std::size_t count) {
    for (std::size_t i = vesicles[count].first; i < data.measurements.size(); ++i)
      for (const Quantity quantity : {Quantity::perimeter, Quantity::rafts})
        data.measurements[i].values[index_of(quantity)] = 0;
  };
  leave(3);
  EXPECT_EQ(calibration::telling_vesicles(data), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(calibration::looks_that_tell_nothing(data),
            static_cast<int>(data.measurements.size() - vesicles[3].first));
  leave(2);
  EXPECT_THROW((void)calibration::telling_vesicles(data), InputError);
}

TEST(LocalRegression, IsExactForParabolas) {
  const std::vector<std::vector<double>> x = calibration::design_around({0.3, -0.2}, 0.5);
  EXPECT_EQ(static_cast<int>(x.size()), calibration::points_of_parabola(2));
  const auto parabola = [](const std::vector<double>& at) {
    return 3 + std::pow(at[0] - 0.5, 2) + 2 * std::pow(at[1] + 0.1, 2) +
           (at[0] - 0.5) * (at[1] + 0.1);
  };
  for (const std::vector<double>& at : {std::vector<double>{0.4, 0.1}, {3, -2}, {-9, 12}}) {
    const std::vector<double> weights = calibration::regression_weights(x, at, 0.5);
    double value = 0;
    for (std::size_t k = 0; k < x.size(); ++k) value += weights[k] * parabola(x[k]);
    EXPECT_NEAR(value, parabola(at), 1e-6 * std::fabs(parabola(at)));
  }
  EXPECT_THROW((void)calibration::regression_weights({{0, 0}, {1, 1}}, {0, 0}, 1),
               std::invalid_argument);
}

TEST(LocalRegression, HardlyLooksFarAway) {
  const std::vector<std::vector<double>> x = {{-0.2}, {0}, {0.1}, {0.2}, {3}};
  const std::vector<double> weights = calibration::regression_weights(x, {0.05}, 0.5);
  EXPECT_LT(std::fabs(weights.back()), 1e-3);
  EXPECT_EQ(calibration::regression_weights({{}}, {}, 1), std::vector<double>{1});
}

}  // namespace
}  // namespace traceraft::observations
