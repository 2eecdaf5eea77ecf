#include "verification/observations/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "kernel/core/types.hpp"
#include "tests/support/published_facts.hpp"
#include "verification/observations/onset.hpp"
#include "verification/observations/perimeter_law.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::observations {
namespace {

TEST(PowerLaw, IsFoundWithItsOriginOfTime) {
  for (const double t0 : {-30.0, 0.0, 21.1, 80.0}) {
    statistics::Points points;
    for (double t = 100; t <= 1000; t *= 1.2) points.emplace_back(t, 53 * std::pow(t - t0, -0.37));
    const statistics::PowerLaw law = statistics::fit_power_law_from(points);
    EXPECT_NEAR(law.t0, t0, 0.01) << t0;
    EXPECT_NEAR(law.b, -0.37, 1e-4);
    EXPECT_NEAR(law.c, 53, 0.05);
    EXPECT_LT(law.scatter, 1e-5);
  }
}

TEST(Published, DrawsWhatWasPublished) {
  PublishedFacts many = testing::facts_of_3to1();
  many.vesicles = 2000;
  many.measurements = 8000;
  const MeasuredVesicles data = draw_measurements(many, 3);
  EXPECT_TRUE(data.synthetic);
  ASSERT_EQ(data.measurements.size(), 8000u);
  EXPECT_EQ(data.vesicles().size(), 2000u);
  std::vector<double> fractions, residuals;
  for (const Measurement& m : data.measurements) {
    fractions.push_back(*m.of(Quantity::fraction));
    residuals.push_back(std::log(*m.of(Quantity::perimeter) / many.perimeter.at(m.time)));
    EXPECT_TRUE(many.window.contains(m.time));
  }
  const statistics::Sample fraction = statistics::sample_of(fractions),
                           residual = statistics::sample_of(residuals);
  EXPECT_NEAR(fraction.mean, 0.09, 0.001);
  EXPECT_NEAR(fraction.deviation, 0.011, 0.0005);
  EXPECT_NEAR(residual.mean, 0, 0.01);
  EXPECT_NEAR(residual.deviation, 0.15, 0.005);
  // The errors that a comparison with runs has to allow for.
  for (const Measurement& m : data.measurements) {
    EXPECT_NEAR(m.sigma_of(Quantity::perimeter) / *m.of(Quantity::perimeter), 0.15 * std::sqrt(0.5),
                1e-12);
    EXPECT_EQ(m.sigma_of(Quantity::fraction), 0.011);
  }
}

TEST(Published, EqualCapsHaveThatPerimeterAndArea) {
  for (const double n : {1.0, 4.0, 9.0}) {
    const double fraction = 0.1, cosine = 1 - 2 * fraction / n;
    EXPECT_NEAR(equal_caps(2 * kPi * n * std::sqrt(1 - cosine * cosine), fraction), n, 1e-9);
  }
}

// An exponential is a power law whose origin is infinitely early.
TEST(PowerLaw, SaysWhereItsOriginIsOpen) {
  const auto open = [](const std::function<double(double)>& perimeter) {
    MeasuredVesicles data;
    for (int k = 0; k < 5; ++k)
      for (double t = 100 + 20 * k; t < 1000; t += 150)
        data.measurements.push_back({"v" + std::to_string(k), t, 5, {perimeter(t), 3.0, 0.1}, {}});
    return fit_measurements(data, {0, 1000}).value().t0_open;
  };
  EXPECT_TRUE(open([](double t) { return 10 * std::exp(-t / 500); }));
  EXPECT_FALSE(open([](double t) { return 10 * std::pow(t, -0.3); }));
}

// A sample of vesicles with one look each may hold one time only.
TEST(PowerLaw, OfFewLooksHasAnInterval) {
  MeasuredVesicles data;
  for (int k = 0; k < 5; ++k)
    data.measurements.push_back(
        {"v" + std::to_string(k), 100.0 * (k + 1), 5, {10.0 / (k + 1), 3.0, 0.1}, {}});
  const auto law = fit_measurements(data, {0, 1000});
  ASSERT_TRUE(law);
  EXPECT_TRUE(std::isfinite(law->b.low) && std::isfinite(law->b.high));
  for (Measurement& m : data.measurements) m.time = 200;
  EXPECT_FALSE(fit_measurements(data, {0, 1000}));
  for (Measurement& m : data.measurements) m.time = 0;
  EXPECT_FALSE(fit_measurements(data, {0, 1000}));
}

// Runs that are power laws times a constant of their own.
std::vector<History> runs(int count, double scale) {
  std::vector<History> all;
  for (int k = 0; k < count; ++k) {
    History run;
    const double own = scale * std::exp(0.2 * std::cos(2.4 * k));
    for (double t = 50; t <= 2000; t *= 1.1) {
      run.time.push_back(t);
      run.of(Quantity::perimeter).push_back(own * 40 * std::pow(t, -1 / 3.0));
      run.of(Quantity::rafts).push_back(std::round(1 + own * 500 / t));
      run.of(Quantity::fraction).push_back(0.1 + 0.01 * own);
    }
    all.push_back(run);
  }
  return all;
}

// A run of the same kind as data, looked at three times.
MeasuredVesicles looked_at(const std::vector<History>& vesicles) {
  MeasuredVesicles data;
  for (std::size_t k = 0; k < vesicles.size(); ++k)
    for (const double t : {100.0, 300.0, 900.0, 1e5}) {
      Measurement m{"v" + std::to_string(k), t, 5, {}, {}};
      for (const Quantity quantity : kQuantities)
        m.values[index_of(quantity)] = vesicles[k].at(quantity, t);
      data.measurements.push_back(m);
    }
  return data;
}

TEST(Comparison, AgreesWithItsOwnKind) {
  const std::vector<History> simulated = runs(20, 1);
  for (const Agreement& a : compare_with_runs(looked_at(simulated), simulated)) {
    EXPECT_EQ(a.measurements, 60);
    EXPECT_EQ(a.beyond, 20);
    EXPECT_EQ(a.within, 60);
    // Rounding to whole rafts weighs small counts less.
    EXPECT_NEAR(a.bias, 0, a.quantity == Quantity::rafts ? 0.1 : 0.01);
    EXPECT_LT(a.misfit, 1.01);
    EXPECT_GT(a.misfit, a.quantity == Quantity::rafts ? 0.1 : 0.93);
  }
}

// Vesicles that the runs have not seen.
TEST(Comparison, KnowsWhatToExpectOfFewRuns) {
  constexpr int kRuns = 8, kSets = 400;
  const auto draw = [](int count, std::uint64_t seed) {
    std::vector<History> all;
    for (int k = 0; k < count; ++k) {
      const auto index = static_cast<std::uint64_t>(k);
      const double own =
          normal_pair(uniform_random(seed, 1, index), uniform_random(seed, 2, index))[0];
      History run;
      run.time = {50, 2000};
      run.of(Quantity::perimeter) = {10 * std::exp(0.2 * own), 10 * std::exp(0.2 * own)};
      run.of(Quantity::rafts) = {5, 5};
      run.of(Quantity::fraction) = {0.1 + 0.01 * own, 0.1 + 0.01 * own};
      all.push_back(run);
    }
    return all;
  };
  double within = 0, squares = 0, count = 0;
  for (std::uint64_t set = 1; set <= kSets; ++set) {
    const Agreement a = compare_with_runs(looked_at(draw(4, 1000 + set)), draw(kRuns, set))[0];
    within += a.within;
    squares += a.misfit * a.misfit * a.measurements;
    count += a.measurements;
  }
  const SameKind expected = same_kind(kRuns);
  EXPECT_NEAR(within / count, expected.within, 0.03);
  EXPECT_NEAR(std::sqrt(squares / count), expected.misfit, 0.08);
  EXPECT_EQ(same_kind(3).misfit, HUGE_VAL);
}

// Curves that differ in level and slope, of which that of all is known.
std::vector<History> curves(int count, std::uint64_t seed, double slope) {
  std::vector<History> all;
  for (int k = 0; k < count; ++k) {
    const auto index = static_cast<std::uint64_t>(k);
    const double level = 0.2 * normal_random(seed, 1, index);
    const double own = slope + 0.1 * normal_random(seed, 2, index);
    History run;
    for (double t = 50; t <= 2000; t *= 1.1) {
      run.time.push_back(t);
      run.of(Quantity::perimeter).push_back(10 * std::exp(level + own * std::log(t / 300)));
      run.of(Quantity::rafts).push_back(5);
      run.of(Quantity::fraction).push_back(0.1);
    }
    all.push_back(run);
  }
  return all;
}

// One in a hundred is taken for a trend (Student's t with seven degrees of freedom beyond 3.5). Of
// 1,000 sets more than 21 have one with a probability of 7e-4, and of three in a hundred 95 %.
TEST(Comparison, SeesATrendAndSeldomOneThatIsNone) {
  constexpr int kSets = 1000;
  int alarms = 0;
  double squares = 0;
  for (std::uint64_t set = 1; set <= kSets; ++set) {
    const Agreement a =
        compare_with_runs(looked_at(curves(17, 1000 + set, -0.3)), curves(8, set, -0.3))[0];
    alarms += a.has_trend();
    squares += std::pow(a.trend / a.trend_error, 2) / kSets;
  }
  EXPECT_LE(alarms, 21);
  EXPECT_GT(alarms, 0);
  // The mean square of Student's t is 7/5, to 0.09 of so many sets.
  EXPECT_NEAR(squares, 7 / 5.0, 4 * 0.09);
  const Agreement steeper =
      compare_with_runs(looked_at(curves(17, 2000, -0.8)), curves(8, 3, -0.3))[0];
  EXPECT_TRUE(steeper.has_trend());
  EXPECT_LT(steeper.trend, 0);
  // Too few of either say nothing of it.
  for (const auto& [vesicles, simulated] : {std::pair(7, 8), std::pair(17, 5)})
    EXPECT_FALSE(
        compare_with_runs(looked_at(curves(vesicles, 2000, -0.8)), curves(simulated, 3, -0.3))[0]
            .has_trend());
}

// Vesicles like the runs, whose clock was started so long before they began.
MeasuredVesicles late_by(double delay, std::uint64_t seed) {
  MeasuredVesicles late = looked_at(curves(17, 1000 + seed, -1.5));
  for (Measurement& m : late.measurements) m.time += delay;
  return late;
}

TEST(Onset, IsFoundWhereItExplainsTheTrend) {
  const auto simulated = curves(8, 3, -1.5);
  EXPECT_FALSE(onset_without_trend(late_by(0, 1), simulated));
  const MeasuredVesicles late = late_by(120, 1);
  ASSERT_TRUE(compare_with_runs(late, simulated)[0].has_trend());
  const auto onset = onset_without_trend(late, simulated);
  ASSERT_TRUE(onset);
  EXPECT_FALSE(onset->at_end);
  EXPECT_FALSE(onset->agreements[0].has_trend());
}

// The onset of one set is known to 9 s.
TEST(Onset, IsThatOfTheVesiclesOnAverage) {
  constexpr int kSets = 40;
  double mean = 0;
  for (std::uint64_t set = 1; set <= kSets; ++set) {
    const auto onset = onset_without_trend(late_by(120, set), curves(8, set, -1.5));
    ASSERT_TRUE(onset) << set;
    mean += onset->delay / kSets;
  }
  EXPECT_NEAR(mean, 120, 4 * 9 / std::sqrt(kSets));
}

TEST(Comparison, SeesVesiclesOfAnotherKind) {
  const auto agreements = compare_with_runs(looked_at(runs(20, 2)), runs(20, 1));
  EXPECT_EQ(agreements[0].within, 0);
  EXPECT_GT(agreements[0].bias, 3);
  EXPECT_GT(agreements[0].misfit, 3);
  EXPECT_TRUE(lies_beside(agreements[0], 20));
  EXPECT_FALSE(lies_beside(compare_with_runs(looked_at(runs(20, 1)), runs(20, 1))[0], 20));
  EXPECT_THROW((void)compare_with_runs(looked_at(runs(2, 1)), runs(1, 1)), InputError);
}

History steady(double perimeter, double rafts, double t_end) {
  History run;
  run.time = {1, t_end};
  run.of(Quantity::perimeter) = {perimeter, perimeter};
  run.of(Quantity::rafts) = {rafts, rafts};
  run.of(Quantity::fraction) = {0.1, 0.1};
  return run;
}

// Runs that are all alike, a look at what they foretell and one at half of that, both known to 2
// µm: of the logarithm's deviation, a quarter, and its mean, 0.0351 lower.
TEST(Comparison, ErrorsAreThoseOfWhatIsExpected) {
  MeasuredVesicles data;
  for (const double perimeter : {8.0, 4.0})
    data.measurements.push_back(
        {"v", 100, 5, {perimeter, std::nullopt, 0.5 * perimeter / 8}, {2.0, std::nullopt, 0.1}});
  const auto agreements = compare_with_runs(data, {steady(8, 4, 500), steady(8, 4, 500)});
  const double right = 4 * 0.0351, half = 4 * (0.0351 - std::log(2.0));
  EXPECT_NEAR(agreements[0].bias, 0.5 * (right + half), 1e-2);
  EXPECT_NEAR(agreements[0].misfit, std::sqrt(0.5 * (right * right + half * half)), 1e-2);
  // Raft fractions as they are.
  EXPECT_NEAR(agreements[2].bias, 0.5 * (4 + 1.5), 1e-6);
}

// Half as many rafts are as far off as twice as many.
TEST(Comparison, WeighsSmallCountsAsLargeOnes) {
  const auto bias_of = [](double rafts) {
    MeasuredVesicles data;
    data.measurements = {{"v", 100, 5, {std::nullopt, rafts, std::nullopt}, {}}};
    return compare_with_runs(data, {steady(8, 4, 500), steady(8, 4, 500)})[1].bias;
  };
  EXPECT_NEAR(bias_of(2), -bias_of(8), 1e-9);
  EXPECT_NEAR(bias_of(8), std::log(2.0) * 4 * std::sqrt(12.0), 1e-9);
}

TEST(Comparison, CountsLooksWithoutRaftsApart) {
  MeasuredVesicles data;
  data.measurements = {{"v", 100, 5, {8.0, 4.0, 0.1}, {}}, {"v", 200, 5, {0.0, 0.0, 0.0}, {}}};
  const auto agreements = compare_with_runs(data, {steady(8, 4, 500), steady(9, 4, 500)});
  for (const Agreement& a : {agreements[0], agreements[1]}) {
    EXPECT_EQ(a.measurements, 1);
    EXPECT_EQ(a.without_rafts, 1);
    EXPECT_LT(std::fabs(a.bias), 1);
  }
  EXPECT_EQ(agreements[2].measurements, 2);
}

TEST(Comparison, SeesRunsWithoutRafts) {
  MeasuredVesicles data;
  data.measurements = {{"v", 100, 5, {8.0, 4.0, 0.1}, {}}, {"v", 900, 5, {8.0, 4.0, 0.1}, {}}};
  const History with = steady(8, 4, 500), without = steady(0, 0, 500);
  EXPECT_EQ(share_without_rafts(data, {with, with}), 0);
  EXPECT_EQ(share_without_rafts(data, {with, without}), 0.5);  // the later look is not covered
  EXPECT_EQ(share_without_rafts(data, {}), 0);
  // Nor is there a law of what is not there.
  std::vector<double> times;
  for (double t = 100; t < 500; t += 20) times.push_back(t);
  EXPECT_TRUE(fit_runs({with, with, without}, times, {100, 500}));
  EXPECT_FALSE(fit_runs({without, with, without}, times, {100, 500}));
}

// The end of the runs, which roundoff may have put before the last look.
TEST(Comparison, IncludesTheEndOfTheRuns) {
  MeasuredVesicles data;
  data.measurements = {{"v", 500, 5, {8.0, 4.0, 0.1}, {}}, {"v", 500.1, 5, {8.0, 4.0, 0.1}, {}}};
  const double end = std::nextafter(500.0, 0.0);
  const Agreement a = compare_with_runs(data, {steady(8, 4, end), steady(9, 4, end)})[0];
  EXPECT_EQ(a.measurements, 1);
  EXPECT_EQ(a.beyond, 1);
}

TEST(PowerLaw, OfRunsHasAnInterval) {
  const std::vector<History> simulated = runs(12, 1);
  const auto law = fit_runs(simulated, common_times(simulated, 24), {100, 1000});
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->law.b, -1 / 3.0, 0.01);
  EXPECT_TRUE(law->c.contains(law->law.c));
  EXPECT_FALSE(fit_runs(runs(2, 1), {100, 200, 300, 400}, {100, 1000}));
  EXPECT_FALSE(fit_runs(simulated, {100, 200, 300}, {100, 1000}));
}

}  // namespace
}  // namespace traceraft::observations
