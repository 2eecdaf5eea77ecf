// Fits to series, on vesicles whose curves are formulas.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "kernel/core/error.hpp"
#include "tests/support/law_vesicles.hpp"
#include "verification/selection/series/series_misfit.hpp"

namespace traceraft::selection {
using namespace law_vesicles;
namespace {

TEST(EnsembleFit, FindsUnitAndStrength) {
  const likelihood::RunCurves base(ensemble({}));
  const likelihood::RunCurves changed(ensemble({-1 / 3.0, 0, 0.05}));
  const auto blocks = likelihood::observed_series(measured({-1 / 3.0, 0, 0.025}, 20, 0.02, 3));
  const likelihood::EnsembleFit fit = likelihood::fit_ensemble(
      blocks, {&base, {&changed}}, likelihood::UnitPrior::within_factor(1, 8));
  EXPECT_NEAR(std::exp(fit.ln_unit), 3, 0.3);
  EXPECT_NEAR(fit.amplitude, 0.5, 4 * fit.deviation);
  EXPECT_LT(fit.deviation, 0.1);
  const likelihood::EnsembleFit without =
      likelihood::fit_ensemble(blocks, {&base}, likelihood::UnitPrior::within_factor(1, 8));
  EXPECT_GT(without.deviance, fit.deviance + 20);
  // 2 ln of the likelihood of all looks together, and of what was known of D.
  const likelihood::EnsembleModel model{&base, {&changed}};
  const likelihood::ObservationMetric metric = likelihood::metric_of(blocks, model, fit);
  const Vec r = likelihood::residual(blocks, model, fit);
  const double known =
      std::pow(fit.ln_unit / likelihood::UnitPrior::within_factor(1, 8).deviation, 2);
  EXPECT_NEAR(fit.deviance, metric.product(r, r) + metric.log_determinant() + known, 1e-8);
}

// Fifty vesicles beside the mean of ten runs, whose own offset is in the fit.
TEST(EnsembleFit, KnowsTheErrorOfTheRuns) {
  constexpr int kDraws = 60;
  double without = 0, with = 0;
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    std::vector<observations::History> runs, more;
    for (std::uint64_t k = 0; k < 10; ++k) {
      runs.push_back(vesicle({}, 1000 + 10 * draw + k));
      more.push_back(vesicle({-1 / 3.0, 0, 0, 0.3}, 1000 + 10 * draw + k));
    }
    const likelihood::RunCurves base(runs), changed(more);
    const auto blocks = likelihood::observed_series(
        measured({-1 / 3.0, 0, 0, 0.15}, 50, 0.05, 1, 10000 + 50 * draw));
    const likelihood::EnsembleModel model{&base, {&changed}};
    const likelihood::EnsembleFit fit =
        likelihood::fit_ensemble(blocks, model, likelihood::UnitPrior::within_factor(1, 1.001));
    const double truth = std::log(1.15) / std::log(1.3), off = fit.amplitude - truth;
    without += std::pow(off / fit.deviation, 2) / kDraws;
    with +=
        std::pow(off / likelihood::with_error_of_runs(blocks, model, fit).deviation, 2) / kDraws;
  }
  EXPECT_GT(without, 3);
  EXPECT_NEAR(with, 1, 0.55);  // three standard deviations of the mean of 60 squares
}

// One raft and two, where as many are expected: what was counted says nothing of how well.
TEST(ObservationMetric, CountsAreKnownByTheNumberExpected) {
  const likelihood::RunCurves base(ensemble({}));
  observations::MeasuredVesicles data;
  for (const double count : {1.0, 2.0, 2.0}) {
    observations::Measurement m;
    m.vesicle = std::to_string(data.measurements.size());
    m.time = 30;
    m.radius = 5;
    m.values[static_cast<std::size_t>(observations::Quantity::rafts)] = count;
    data.measurements.push_back(m);
  }
  data.measurements.back().sigma[static_cast<std::size_t>(observations::Quantity::rafts)] = 0.5;
  const auto blocks = likelihood::observed_series(data);
  const auto known =
      likelihood::known_covariance(blocks, base, 0, likelihood::expected(blocks, {&base}, {}));
  const double ln_t = std::log(30.0),
               expected = std::exp(base.mean(observations::Quantity::rafts, ln_t));
  const double runs = base.variance(observations::Quantity::rafts, ln_t);
  EXPECT_NEAR(known[0](0, 0) - runs, 1 / 12.0 / (expected * expected), 1e-12);
  EXPECT_NEAR(known[1](0, 0), known[0](0, 0), 1e-12);
  EXPECT_NEAR(known[2](0, 0) - runs, 0.25 / (expected * expected),
              1e-12);  // a stated error, if larger
}

// Errors of two fifths of the mean: what noise makes large is not known better by its logarithm,
// whose mean is below that of what is expected.
TEST(EnsembleFit, IsNotPulledByErrorsThatAreAbsolute) {
  observations::MeasuredVesicles data = measured({}, 60, 0, 1);
  const auto fraction = static_cast<std::size_t>(observations::Quantity::fraction);
  std::uint64_t k = 0;
  for (observations::Measurement& m : data.measurements) {
    double& value = m.values[fraction].emplace(0);
    while (!(value > 0)) value = 0.1 * (1 + 0.4 * normal_random(50, 1, k++));
    m.sigma[fraction] = 0.04;
  }
  const likelihood::RunCurves base(ensemble({}));
  const auto blocks = likelihood::observed_series(data);
  const likelihood::EnsembleFit fit =
      likelihood::fit_ensemble(blocks, {&base}, likelihood::UnitPrior::within_factor(1, 8));
  const SeriesOffset offset = offsets(blocks, {&base}, fit).at(2);
  EXPECT_NEAR(offset.level, 0, 2.5 * 0.4 / std::sqrt(360));
}

// Values that agree with the model: ln(1 + s z) is 0.0956 below on average for s = 0.4.
TEST(EnsembleFit, ResidualsKnowTheMeanOfLogarithms) {
  const likelihood::RunCurves base(ensemble({}));
  observations::MeasuredVesicles data = measured({}, 3, 0, 1);
  for (observations::Measurement& m : data.measurements)
    m.sigma[static_cast<std::size_t>(observations::Quantity::fraction)] = 0.04;
  const auto blocks = likelihood::observed_series(data);
  const Vec r = likelihood::residual(blocks, {&base}, {});
  Eigen::Index i = 0;
  for (const likelihood::ObservedSeries& block : blocks)
    for (Eigen::Index k = 0; k < block.values.size(); ++k, ++i)
      if (block.quantity == observations::Quantity::fraction) {
        EXPECT_NEAR(r[i], 0.0956, 1e-4);
      }
}

// Absolute errors are half as large a part of twice the value.
TEST(ObservationMetric, ErrorsAreThoseOfTheChangedModel) {
  const std::vector<observations::History> alike(3, vesicle({}, 1));
  std::vector<observations::History> twice = alike;
  for (observations::History& run : twice)
    for (double& x : run.of(observations::Quantity::fraction)) x *= 2;
  const likelihood::RunCurves base(alike), changed(twice);
  observations::Measurement look{"a", 30, 5, {}, {}};
  look.values[static_cast<std::size_t>(observations::Quantity::fraction)] = 0.1;
  look.sigma[static_cast<std::size_t>(observations::Quantity::fraction)] = 0.02;
  observations::MeasuredVesicles data;
  data.measurements = {look};
  const auto blocks = likelihood::observed_series(data);
  const auto variance = [&](double amplitude) {
    likelihood::EnsembleFit fit;
    fit.amplitude = amplitude;
    return 1 / likelihood::metric_of(blocks, {&base, {&changed}}, fit)
                   .product(Vec::Ones(1), Vec::Ones(1));
  };
  EXPECT_NEAR(variance(0), 0.04, 1e-6);
  EXPECT_NEAR(variance(1), 0.01, 1e-6);
}

// One more run scatters about the mean of n with a variance of 1 + 1/n.
TEST(RunCurves, KnowHowOneMoreRunScatters) {
  observations::History low = vesicle({}, 1), high = low;
  for (double& p : high.of(observations::Quantity::perimeter)) p *= std::exp(0.2);
  const likelihood::RunCurves curves({low, high});
  EXPECT_NEAR(curves.variance(observations::Quantity::perimeter, 1), 1.5 * 0.2 * 0.2 / 2, 1e-12);
}

// A run that has lost its rafts for a moment does not outweigh the others.
TEST(RunCurves, RunsWithoutRaftsCountAsHalfARaft) {
  const observations::History some =
      vesicle({0}, 1);  // at rest: what curves are smoothed by makes no difference
  observations::History none = some;
  for (const observations::Quantity quantity : observations::kQuantities)
    for (double& value : none.of(quantity)) value = 0;
  const likelihood::RunCurves curves({some, none});
  EXPECT_NEAR(curves.mean(observations::Quantity::rafts, 0),
              0.5 * (std::log(some.at(observations::Quantity::rafts, 1)) + std::log(0.5)), 1e-9);
  EXPECT_GT(curves.mean(observations::Quantity::fraction, 0),
            0.5 * (std::log(0.1) + std::log(1e-3)));
}

TEST(ObservationMetric, IsThatOfTheDenseCovariance) {
  const likelihood::RunCurves base(ensemble({}));
  std::vector<likelihood::ObservedSeries> blocks =
      likelihood::observed_series(measured({}, 3, 0.1, 1));
  blocks.erase(blocks.begin() + 2, blocks.end());
  const likelihood::ObservationScatter scatter{{0.3, 0.2, 0.1}, {0.05, 0.15, 0.25}};
  likelihood::EnsembleFit fit;
  fit.ln_unit = 0.1;
  const auto known =
      likelihood::known_covariance(blocks, base, 0.1, likelihood::expected(blocks, {&base}, fit));
  const likelihood::ObservationMetric metric(blocks, known, scatter);
  const Eigen::Index n = blocks[0].values.size(), all = n + blocks[1].values.size();
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(all, all);
  for (std::size_t b = 0; b < 2; ++b) {
    const Eigen::Index first = b == 0 ? 0 : n, count = blocks[b].values.size();
    const observations::Quantity quantity = blocks[b].quantity;
    const auto q = observations::index_of(quantity);
    S.block(first, first, count, count) =
        base.covariance(quantity, blocks[b].ln_t.array() - 0.1).array() +
        scatter.vesicle[q] * scatter.vesicle[q];
    for (Eigen::Index i = 0; i < count; ++i) {
      const double t = blocks[b].ln_t[i] - 0.1;
      const double expected = std::exp(base.mean(quantity, t));
      const double stated = quantity == observations::Quantity::rafts ? 1 / 12.0 : 0;
      S(first + i, first + i) += stated / (expected * expected) + scatter.look[q] * scatter.look[q];
    }
  }
  const Vec u = Vec::LinSpaced(all, -1, 2), v = u.array().square();
  EXPECT_NEAR(metric.product(u, v), u.dot(S.ldlt().solve(v)), 1e-9);
  EXPECT_NEAR(metric.log_determinant(), std::log(S.determinant()), 1e-9);
  Vec first = v;
  first.tail(all - n).setZero();
  EXPECT_NEAR(metric.product(u, v, blocks[0].quantity), u.dot(S.ldlt().solve(first)), 1e-9);
  const likelihood::ObservationMetric alone(blocks, known, scatter, blocks[0].quantity);
  EXPECT_NEAR(alone.product(u, v), u.dot(S.ldlt().solve(first)), 1e-9);
  EXPECT_NEAR(alone.log_determinant(), std::log(S.topLeftCorner(n, n).determinant()), 1e-9);
}

TEST(SeriesExplanation, SaysHowManyVesiclesItWouldTake) {
  const SeriesExplanation few = explained(measured({}, 3, 1, 1));
  EXPECT_EQ(few.finding, Finding::not_identifiable);
  for (const SeriesScore& score : few.scores) EXPECT_GT(score.vesicles, 3) << score.effect;
}

TEST(SeriesExplanation, RefusesTooFewVesicles) {
  EXPECT_THROW(explained(measured({}, 2, 0.05, 1)), InputError);
}

}  // namespace
}  // namespace traceraft::selection
