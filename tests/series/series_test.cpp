// What series say, on vesicles whose curves are formulas.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "verification/series/series_explanation.hpp"
#include "verification/series/series_misfit.hpp"
#include "verification/statistics/bootstrap.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft {
namespace {

// A vesicle at times of 1 to 1000 units: the perimeter falls like t^(−1/3) to a plateau, the
// fraction drifts, and there are more rafts of the same perimeter.
struct Law {
  double exponent = -1 / 3.0, plateau = 0, drift = 0, more_rafts = 0;
};
History vesicle(const Law& law, std::uint64_t seed, double seconds_per_unit = 1) {
  History history;
  const double own = 0.08 * normal_random(seed, 1, 0);
  for (int k = 0; k <= 60; ++k) {
    const double t = std::pow(10.0, k / 20.0);
    const double p = (30 * std::pow(t, law.exponent) + law.plateau) * std::exp(own);
    history.time.push_back(t * seconds_per_unit);
    history.of(Quantity::perimeter).push_back(p);
    history.of(Quantity::rafts)
        .push_back(std::max(1.0, std::round((1 + law.more_rafts) * p * p / 10)));
    history.of(Quantity::fraction).push_back(0.1 * (1 + law.drift * std::log(t)));
  }
  return history;
}

std::vector<History> ensemble(const Law& law) {
  std::vector<History> runs;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) runs.push_back(vesicle(law, seed));
  return runs;
}

std::vector<SeriesCandidate> candidates() {
  return {{"uptake", 2, true, ensemble({-1 / 3.0, 0, 0.05})},
          {"cooling", 1, true, ensemble({-1 / 3.0, 0, 0.06})},
          {"ohta-kawasaki", 3, false, ensemble({-1 / 3.0, 2, 0})},
          {"line-tension", 1, true, ensemble({-1 / 3.0, 0, 0, 0.3})}};
}

MeasuredVesicles measured(const Law& law, int vesicles, double noise, double seconds_per_unit,
                          std::uint64_t first_seed = 100) {
  MeasuredVesicles data;
  for (int v = 0; v < vesicles; ++v) {
    const History history =
        vesicle(law, first_seed + static_cast<std::uint64_t>(v), seconds_per_unit);
    for (int k = 0; k < 6; ++k) {
      Measurement m;
      m.vesicle = std::to_string(v);
      m.time = seconds_per_unit * std::pow(10.0, 0.3 + 0.45 * k + 0.02 * (v % 20));
      m.radius = 5;
      for (const Quantity quantity : kQuantities) {
        const auto q = index_of(quantity);
        const double scatter =
            noise * normal_random(7 + q, 1, static_cast<std::uint64_t>(10 * v + k));
        m.values[q] = history.at(quantity, m.time) * std::exp(scatter);
      }
      data.measurements.push_back(m);
    }
  }
  return data;
}

SeriesExplanation explained(const MeasuredVesicles& data) {
  SeriesRequest request{UnitPrior::within_factor(1, 8)};
  request.replicates = 99;
  return explain_series(data, ensemble({}), candidates(), request);
}

// Where it does not matter what effects do.
SeriesExplanation compared(const MeasuredVesicles& data, const SeriesRequest& request) {
  return explain_series(data, ensemble({}), {candidates()[0]}, request);
}

void keep_only(Quantity kept, MeasuredVesicles& data) {
  for (Measurement& m : data.measurements)
    for (const Quantity quantity : kQuantities)
      if (quantity != kept) m.values[index_of(quantity)].reset();
}

TEST(EnsembleFit, FindsUnitAndStrength) {
  const RunCurves base(ensemble({}));
  const RunCurves changed(ensemble({-1 / 3.0, 0, 0.05}));
  const auto blocks = observed_series(measured({-1 / 3.0, 0, 0.025}, 20, 0.02, 3));
  const EnsembleFit fit = fit_ensemble(blocks, {&base, &changed}, UnitPrior::within_factor(1, 8));
  EXPECT_NEAR(std::exp(fit.ln_unit), 3, 0.3);
  EXPECT_NEAR(fit.amplitude, 0.5, 4 * fit.deviation);
  EXPECT_LT(fit.deviation, 0.1);
  const EnsembleFit without = fit_ensemble(blocks, {&base}, UnitPrior::within_factor(1, 8));
  EXPECT_GT(without.deviance, fit.deviance + 20);
  // 2 ln of the likelihood of all looks together, and of what was known of D.
  const EnsembleModel model{&base, &changed};
  const ObservationMetric metric = metric_of(blocks, model, fit);
  const Vec r = residual(blocks, model, fit);
  const double known = std::pow(fit.ln_unit / UnitPrior::within_factor(1, 8).deviation, 2);
  EXPECT_NEAR(fit.deviance, metric.product(r, r) + metric.log_determinant() + known, 1e-8);
}

// One raft and two, where as many are expected: what was counted says nothing of how well.
TEST(ObservationMetric, CountsAreKnownByTheNumberExpected) {
  const RunCurves base(ensemble({}));
  MeasuredVesicles data;
  for (const double count : {1.0, 2.0, 2.0}) {
    Measurement m;
    m.vesicle = std::to_string(data.measurements.size());
    m.time = 30;
    m.radius = 5;
    m.values[static_cast<std::size_t>(Quantity::rafts)] = count;
    data.measurements.push_back(m);
  }
  data.measurements.back().sigma[static_cast<std::size_t>(Quantity::rafts)] = 0.5;
  const auto blocks = observed_series(data);
  const auto known = known_covariance(blocks, base, 0, traceraft::expected(blocks, {&base}, {}));
  const double ln_t = std::log(30.0), expected = std::exp(base.mean(Quantity::rafts, ln_t));
  const double runs = base.variance(Quantity::rafts, ln_t);
  EXPECT_NEAR(known[0](0, 0) - runs, 1 / 12.0 / (expected * expected), 1e-12);
  EXPECT_NEAR(known[1](0, 0), known[0](0, 0), 1e-12);
  EXPECT_NEAR(known[2](0, 0) - runs, 0.25 / (expected * expected),
              1e-12);  // a stated error, if larger
}

// Errors of two fifths of the mean: what noise makes large is not known better by its logarithm,
// whose mean is below that of what is expected.
TEST(EnsembleFit, IsNotPulledByErrorsThatAreAbsolute) {
  MeasuredVesicles data = measured({}, 60, 0, 1);
  const auto fraction = static_cast<std::size_t>(Quantity::fraction);
  std::uint64_t k = 0;
  for (Measurement& m : data.measurements) {
    double& value = m.values[fraction].emplace(0);
    while (!(value > 0)) value = 0.1 * (1 + 0.4 * normal_random(50, 1, k++));
    m.sigma[fraction] = 0.04;
  }
  const RunCurves base(ensemble({}));
  const auto blocks = observed_series(data);
  const EnsembleFit fit = fit_ensemble(blocks, {&base}, UnitPrior::within_factor(1, 8));
  const SeriesOffset offset = offsets(blocks, {&base}, fit).at(2);
  EXPECT_NEAR(offset.level, 0, 2.5 * 0.4 / std::sqrt(360));
}

// Of values that are what is expected: ln(1 + s z) is 0.0956 below that on average for s = 0.4.
TEST(EnsembleFit, ResidualsKnowTheMeanOfLogarithms) {
  const RunCurves base(ensemble({}));
  MeasuredVesicles data = measured({}, 3, 0, 1);
  for (Measurement& m : data.measurements)
    m.sigma[static_cast<std::size_t>(Quantity::fraction)] = 0.04;
  const auto blocks = observed_series(data);
  const Vec r = residual(blocks, {&base}, {});
  Eigen::Index i = 0;
  for (const ObservedSeries& block : blocks)
    for (Eigen::Index k = 0; k < block.values.size(); ++k, ++i)
      if (block.quantity == Quantity::fraction) {
        EXPECT_NEAR(r[i], 0.0956, 1e-4);
      }
}

// Absolute errors are half as large a part of twice the value.
TEST(ObservationMetric, ErrorsAreThoseOfTheChangedModel) {
  const std::vector<History> alike(3, vesicle({}, 1));
  std::vector<History> twice = alike;
  for (History& run : twice)
    for (double& x : run.of(Quantity::fraction)) x *= 2;
  const RunCurves base(alike), changed(twice);
  Measurement look{"a", 30, 5, {}, {}};
  look.values[static_cast<std::size_t>(Quantity::fraction)] = 0.1;
  look.sigma[static_cast<std::size_t>(Quantity::fraction)] = 0.02;
  MeasuredVesicles data;
  data.measurements = {look};
  const auto blocks = observed_series(data);
  const auto variance = [&](double amplitude) {
    EnsembleFit fit;
    fit.amplitude = amplitude;
    return 1 / metric_of(blocks, {&base, &changed}, fit).product(Vec::Ones(1), Vec::Ones(1));
  };
  EXPECT_NEAR(variance(0), 0.04, 1e-6);
  EXPECT_NEAR(variance(1), 0.01, 1e-6);
}

// One more run scatters about the mean of n with a variance of 1 + 1/n.
TEST(RunCurves, KnowHowOneMoreRunScatters) {
  History low = vesicle({}, 1), high = low;
  for (double& p : high.of(Quantity::perimeter)) p *= std::exp(0.2);
  const RunCurves curves({low, high});
  EXPECT_NEAR(curves.variance(Quantity::perimeter, 1), 1.5 * 0.2 * 0.2 / 2, 1e-12);
}

// A run that has lost its rafts for a moment does not outweigh the others.
TEST(RunCurves, RunsWithoutRaftsCountAsHalfARaft) {
  const History some = vesicle({0}, 1);  // at rest: what curves are smoothed by makes no difference
  History none = some;
  for (const Quantity quantity : kQuantities)
    for (double& value : none.of(quantity)) value = 0;
  const RunCurves curves({some, none});
  EXPECT_NEAR(curves.mean(Quantity::rafts, 0),
              0.5 * (std::log(some.at(Quantity::rafts, 1)) + std::log(0.5)), 1e-9);
  EXPECT_GT(curves.mean(Quantity::fraction, 0), 0.5 * (std::log(0.1) + std::log(1e-3)));
}

TEST(ObservationMetric, IsThatOfTheDenseCovariance) {
  const RunCurves base(ensemble({}));
  std::vector<ObservedSeries> blocks = observed_series(measured({}, 3, 0.1, 1));
  blocks.erase(blocks.begin() + 2, blocks.end());
  const ObservationScatter scatter{{0.3, 0.2, 0.1}, {0.05, 0.15, 0.25}};
  EnsembleFit fit;
  fit.ln_unit = 0.1;
  const auto known = known_covariance(blocks, base, 0.1, expected(blocks, {&base}, fit));
  const ObservationMetric metric(blocks, known, scatter);
  const Eigen::Index n = blocks[0].values.size(), all = n + blocks[1].values.size();
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(all, all);
  for (std::size_t b = 0; b < 2; ++b) {
    const Eigen::Index first = b == 0 ? 0 : n, count = blocks[b].values.size();
    const Quantity quantity = blocks[b].quantity;
    const auto q = index_of(quantity);
    S.block(first, first, count, count) =
        base.covariance(quantity, blocks[b].ln_t.array() - 0.1).array() +
        scatter.vesicle[q] * scatter.vesicle[q];
    for (Eigen::Index i = 0; i < count; ++i) {
      const double t = blocks[b].ln_t[i] - 0.1;
      const double expected = std::exp(base.mean(quantity, t));
      const double stated = quantity == Quantity::rafts ? 1 / 12.0 : 0;
      S(first + i, first + i) += stated / (expected * expected) + scatter.look[q] * scatter.look[q];
    }
  }
  const Vec u = Vec::LinSpaced(all, -1, 2), v = u.array().square();
  EXPECT_NEAR(metric.product(u, v), u.dot(S.ldlt().solve(v)), 1e-9);
  EXPECT_NEAR(metric.log_determinant(), std::log(S.determinant()), 1e-9);
  Vec first = v;
  first.tail(all - n).setZero();
  EXPECT_NEAR(metric.product(u, v, blocks[0].quantity), u.dot(S.ldlt().solve(first)), 1e-9);
  const ObservationMetric alone(blocks, known, scatter, blocks[0].quantity);
  EXPECT_NEAR(alone.product(u, v), u.dot(S.ldlt().solve(first)), 1e-9);
  EXPECT_NEAR(alone.log_determinant(), std::log(S.topLeftCorner(n, n).determinant()), 1e-9);
}

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
  EXPECT_EQ(score->telling, Quantity::fraction);
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

// Errors that are stated are no signal, and the data that calibrate it have them as well.
TEST(SeriesExplanation, KnowsErrorsThatAreStated) {
  int alarms = 0;
  for (std::uint64_t set = 0; set < 8; ++set) {
    MeasuredVesicles data = measured({}, 10, 0, 1);
    std::uint64_t k = 0;
    for (Measurement& m : data.measurements)
      for (const Quantity quantity : kQuantities) {
        const auto q = index_of(quantity);
        m.sigma[q] = 0.2 * *m.values[q];
        m.values[q] = *m.values[q] * std::exp(0.2 * normal_random(50 + set, 1, k++));
      }
    alarms += explained(data).p <= 0.05;
  }
  EXPECT_LE(alarms, 2);
}

// Raft fractions known no better than to themselves say little, and nothing that is wrong.
TEST(SeriesExplanation, KnowsErrorsAsLargeAsTheValues) {
  const auto fraction = static_cast<std::size_t>(Quantity::fraction);
  const std::vector<SeriesCandidate> all = candidates();
  SeriesRequest request{UnitPrior::within_factor(1, 8)};
  request.replicates = 99;
  for (const double sigma : {0.1, 0.2}) {
    int alarms = 0;
    for (std::uint64_t set = 0; set < 6; ++set) {
      MeasuredVesicles data = measured({}, 10, 0.05, 1, 1000 * (set + 1));
      std::uint64_t k = 0;
      for (Measurement& m : data.measurements) {
        double& value = m.values[fraction].emplace(0);
        while (!(value > 0)) value = 0.1 + sigma * normal_random(60 + set, 1, k++);
        m.sigma[fraction] = sigma;
      }
      const SeriesExplanation found = explain_series(data, ensemble({}), {all[0], all[3]}, request);
      alarms += found.p <= 0.05 || found.finding == Finding::unnamed;
    }
    EXPECT_LE(alarms, 1) << sigma;
  }
}

// What is zero has no logarithm, and those who state an error of it have said nothing more.
TEST(SeriesExplanation, LooksWithoutRaftsSayNothing) {
  MeasuredVesicles data = measured({}, 10, 0.05, 1);
  const auto rafts = static_cast<std::size_t>(Quantity::rafts);
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
  MeasuredVesicles fast = measured({}, 15, 0.05, 1);
  for (Measurement& m : fast.measurements) {
    const History run = vesicle({}, 3);
    for (const Quantity quantity : kQuantities)
      m.values[index_of(quantity)] = run.at(quantity, std::min(1000.0, 3 * m.time));
  }
  EXPECT_GT(std::exp(explained(fast).base.ln_unit), 0.6);
  for (Measurement& m : fast.measurements) m.time *= 20;
  EXPECT_THROW(explained(fast), InputError);
}

TEST(SeriesExplanation, AdmitsATrendThatNothingExplains) {
  const SeriesExplanation found = explained(measured({-0.6, 0, 0}, 15, 0.05, 1));
  EXPECT_EQ(found.finding, Finding::unnamed);
  EXPECT_LE(found.trend_p, 0.02);
  // What it is: perimeters that fall faster than t^(-1/3); of rafts one is left soon.
  ASSERT_EQ(found.offsets.size(), 3u);
  EXPECT_EQ(found.offsets[0].quantity, Quantity::perimeter);
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

// Forty vesicles know their mean better than ten runs know that of the model: what lies beside it
// then is not so many deviations of the vesicles alone, √(1 + 40/10).
TEST(EnsembleFit, CountsDeviationsWithTheScatterOfTheRuns) {
  double squares = 0;
  constexpr int kSets = 10;
  for (std::uint64_t set = 1; set <= kSets; ++set) {
    SeriesRequest request{UnitPrior::within_factor(1, 1.1)};
    request.replicates = 29;
    std::vector<History> runs;
    for (std::uint64_t k = 0; k < 10; ++k) runs.push_back(vesicle({}, 1000 * set + k));
    const std::vector<SeriesCandidate> alone{{"uptake", 2, true, runs}};
    MeasuredVesicles data = measured({}, 40, 0.02, 1, 1000 * set + 100);
    keep_only(Quantity::perimeter, data);
    const SeriesExplanation found = explain_series(data, runs, alone, request);
    squares += std::pow(found.offsets[0].level_deviations, 2);
  }
  EXPECT_LT(std::sqrt(squares / kSets), 1.6);
  EXPECT_GT(std::sqrt(squares / kSets), 0.5);
}

// What another D does is seen where D is known.
TEST(SeriesExplanation, SeesWhatAnotherDDoesIfDIsKnown) {
  MeasuredVesicles data = measured({}, 20, 0.05, 1);
  for (Measurement& m : data.measurements)  // whole numbers are not quite alike
    m.values[static_cast<std::size_t>(Quantity::rafts)].reset();
  std::vector<History> slower;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) slower.push_back(vesicle({}, seed, 2));
  const auto explained_with = [&](double factor) {
    SeriesRequest request{UnitPrior::within_factor(1, factor)};
    request.replicates = 49;
    return explain_series(data, ensemble({}), {{"bulk-mobility", 1, true, slower}}, request);
  };
  const SeriesExplanation unknown = explained_with(8), known = explained_with(1.05);
  EXPECT_EQ(unknown.finding, Finding::not_identifiable);
  EXPECT_TRUE(std::isinf(unknown.scores[0].vesicles));
  EXPECT_EQ(known.finding, Finding::none);
  EXPECT_LT(known.scores[0].vesicles, 20);
}

// D is 1. Perimeters scatter by 8 % between vesicles and between runs and fall as t^(-1/3), so that
// ln t is known to 0.24 from one of them.
TEST(SeriesExplanation, KnowsHowWellItKnowsD) {
  for (const int vesicles : {4, 20}) {
    const SeriesExplanation found = explained(measured({}, vesicles, 0.1, 1));
    EXPECT_LT(std::fabs(found.base.ln_unit), 2 * found.unit_deviation);
    const double expected = student_factor(10) * 0.24 * std::sqrt(1.0 / vesicles + 1.0 / 10);
    EXPECT_NEAR(found.unit_deviation, expected, 0.25 * expected);
  }
}

// Where the fit may go no further up it is known as well as downwards.
TEST(SeriesExplanation, KnowsHowWellItKnowsDNearAnEnd) {
  MeasuredVesicles data = measured({}, 20, 0.1, 1);
  auto& looks = data.measurements;  // a D far larger would not end the runs before the last look
  looks.erase(
      std::remove_if(looks.begin(), looks.end(), [](const Measurement& m) { return m.time > 150; }),
      looks.end());
  SeriesRequest request{UnitPrior::within_factor(1, 8)};
  request.replicates = 199;
  const SeriesExplanation open = compared(data, request);
  const double best = std::exp(open.base.ln_unit);
  for (const double further : {1.02, 10.0}) {
    request.unit = UnitPrior::within_factor(best * further / 8, 8);
    const SeriesExplanation found = compared(data, request);
    EXPECT_NEAR(found.unit_deviation, open.unit_deviation, 0.2 * open.unit_deviation) << further;
  }
}

// Of three runs, drawn for each set anew: without Student's factor 29 of 40 held.
TEST(SeriesExplanation, IntervalsOfDHoldTheTruth) {
  constexpr int kSets = 20, kRuns = 3;
  int held = 0;
  for (std::uint64_t set = 1; set <= kSets; ++set) {
    std::vector<History> base, more_rafts;
    for (std::uint64_t k = 0; k < kRuns; ++k) {
      base.push_back(vesicle({}, 1000 * set + k));
      more_rafts.push_back(vesicle({-1 / 3.0, 0, 0, 0.3}, 1000 * set + k));
    }
    MeasuredVesicles data = measured({}, 16, 0.1, 1, 1000 * set + 500);
    for (Measurement& m : data.measurements)
      m.values[static_cast<std::size_t>(Quantity::fraction)].reset();
    SeriesRequest request{UnitPrior::within_factor(1, 8)};
    request.replicates = 49;
    const SeriesExplanation found =
        explain_series(data, base, {{"line-tension", 1, true, more_rafts}}, request);
    held += std::fabs(found.base.ln_unit) < kNormal95 * found.unit_deviation;
  }
  EXPECT_GE(held, kSets * 95 / 100);
}

// Of a D that is known to 2 % nothing that fits it is at the end.
TEST(SeriesExplanation, LooksAroundADThatIsKnown) {
  SeriesRequest request{UnitPrior::within_factor(1, std::exp(0.04), 2)};
  request.replicates = 49;
  const SeriesExplanation found =
      explain_series(measured({}, 4, 0.1, 1), ensemble({}), candidates(), request);
  EXPECT_FALSE(found.unit_at_end);
}

// Where nothing coarsens, series say nothing of it.
TEST(SeriesExplanation, KnowsThatItDoesNotKnowD) {
  const Law rest{0};
  SeriesRequest request{UnitPrior::within_factor(1, 8)};
  request.replicates = 99;
  std::vector<SeriesCandidate> more_rafts{{"line-tension", 1, true, ensemble({0, 0, 0, 0.3})}};
  const SeriesExplanation found =
      explain_series(measured(rest, 10, 0.1, 1), ensemble(rest), more_rafts, request);
  EXPECT_FALSE(found.unit_told);
  EXPECT_FALSE(found.unit_at_end);
  EXPECT_NEAR(found.unit_deviation, std::log(8.0) / 2, 0.25 * std::log(8.0) / 2);
  // Three runs say even less, but what was known before is known.
  std::vector<History> few = ensemble(rest);
  few.resize(3);
  more_rafts[0].runs.resize(3);
  const double of_few =
      explain_series(measured(rest, 10, 0.1, 1), few, more_rafts, request).unit_deviation;
  EXPECT_LE(of_few, std::log(8.0) / kNormal95);
  EXPECT_GT(of_few, 0.75 * std::log(8.0) / kNormal95);
  const SeriesExplanation told = explained(measured({}, 10, 0.1, 1));
  EXPECT_TRUE(told.unit_told);
  const SeriesExplanation far = explained(measured({}, 10, 0.1, 1 / 30.0));
  EXPECT_TRUE(far.unit_at_end);
}

// By its logarithm, like the others.
TEST(EnsembleFit, SaysHowFarTheRaftFractionLiesBesideIt) {
  MeasuredVesicles data = measured({}, 15, 0.02, 1);
  for (Measurement& m : data.measurements)
    *m.values[static_cast<std::size_t>(Quantity::fraction)] *= 2;
  const SeriesOffset offset = explained(data).offsets.at(2);
  EXPECT_EQ(offset.quantity, Quantity::fraction);
  EXPECT_NEAR(offset.level, std::log(2.0), 0.02);
}

TEST(SeriesExplanation, SaysHowManyVesiclesItWouldTake) {
  const SeriesExplanation few = explained(measured({}, 3, 1, 1));
  EXPECT_EQ(few.finding, Finding::not_identifiable);
  for (const SeriesScore& score : few.scores) EXPECT_GT(score.vesicles, 3) << score.effect;
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
    const double deviation = (score.high - score.low) / 2 / 1.96 / candidate->strength;
    ASSERT_TRUE(std::isfinite(score.vesicles)) << score.effect;
    EXPECT_NEAR(score.vesicles, 15 * 16 * deviation * deviation, 0.25 * score.vesicles)
        << score.effect;
  }
}

// Classes that are nearly as probable as the best one are named with what would tell them apart.
TEST(SeriesExplanation, SaysWhatWouldTellClassesApart) {
  constexpr int kVesicles = 8, kMore = 20;
  std::vector<SeriesCandidate> two = {candidates()[0]};                  // a drift of the fraction
  two.push_back({"cooling", 1, true, ensemble({-1 / 3.0, 0.6, 0.05})});  // and a plateau
  SeriesRequest request{UnitPrior::within_factor(1, 8)};
  request.replicates = 99;
  const auto explain = [&](const Law& law, int vesicles) {
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
  EXPECT_NE(tie.telling, Quantity::fraction);
  // These do not tell them apart, more of one of them do.
  EXPECT_GT(tie.vesicles, kVesicles);
  EXPECT_LT(tie.vesicles, kMore);
  const SeriesExplanation told = explain({-1 / 3.0, 0.6, 0.05}, kMore);
  EXPECT_EQ(told.finding, Finding::named);
  EXPECT_EQ(told.named[0], std::vector<std::string>{"cooling"});
}

TEST(SeriesExplanation, RefusesTooFewVesicles) {
  EXPECT_THROW(explained(measured({}, 2, 0.05, 1)), InputError);
}

}  // namespace
}  // namespace traceraft
