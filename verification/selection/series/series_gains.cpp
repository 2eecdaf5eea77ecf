#include "verification/selection/series/series_gains.hpp"

#include <algorithm>
#include <cmath>

#include "verification/likelihood/drawn_vesicles.hpp"

namespace traceraft::selection {
namespace {

constexpr std::uint64_t kOthers = 4;  // stream of random numbers

likelihood::RunCurves others_of(const std::vector<observations::History>& runs,
                                const Eigen::MatrixXd& weights) {
  return likelihood::RunCurves(
      likelihood::RunSamples(runs, observations::common_times(runs, observations::kCurveTimes))
          .others(weights));
}

}  // namespace

SeriesCurves::SeriesCurves(const std::vector<observations::History>& runs,
                           const std::vector<SeriesCandidate>& candidates)
    : base(runs) {
  for (const SeriesCandidate& candidate : candidates) changed.emplace_back(candidate.runs);
}

SeriesCurves::SeriesCurves(const std::vector<observations::History>& runs,
                           const std::vector<SeriesCandidate>& candidates,
                           const Eigen::MatrixXd& weights)
    : base(others_of(runs, weights)) {
  for (const SeriesCandidate& candidate : candidates)
    changed.push_back(others_of(candidate.runs, weights));
}

SeriesGains gains_of(const std::vector<likelihood::ObservedSeries>& blocks,
                     const SeriesCurves& curves, const std::vector<SeriesCandidate>& candidates,
                     const likelihood::UnitPrior& unit, const likelihood::EnsembleFit& base) {
  SeriesGains gains;
  gains.base = base;
  gains.trend = trend_left(blocks, {&curves.base}, gains.base);
  gains.offsets = offsets(blocks, {&curves.base}, gains.base);
  gains.values.resize(static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    gains.fits.push_back(likelihood::fit_ensemble(
        blocks, {&curves.base, &curves.changed[k], candidates[k].two_sided}, unit, gains.base));
    gains.values[static_cast<Eigen::Index>(k)] =
        std::max(0.0, gains.base.deviance - gains.fits[k].deviance);
  }
  return gains;
}

// Data of the base model, fitted with the mean of other runs like those that there are.
SeriesNull null_of(const observations::MeasuredVesicles& data,
                   const std::vector<observations::History>& runs,
                   const std::vector<SeriesCandidate>& candidates,
                   const likelihood::EnsembleFit& fit, const likelihood::UnitPrior& unit,
                   int replicates) {
  SeriesNull result;
  const observations::StatedErrors errors(data);
  const auto count = static_cast<Eigen::Index>(candidates.size());
  Eigen::MatrixXd gained(replicates, count);
  result.trend.resize(replicates);
  result.ln_unit.resize(replicates);
  for (int r = 0; r < replicates; ++r) {
    const auto replicate = static_cast<std::uint64_t>(r + 1);
    const std::vector<likelihood::ObservedSeries> blocks = likelihood::observed_series(
        likelihood::drawn_vesicles(data, errors, {&runs}, fit, replicate));
    const likelihood::UnitPrior known = likelihood::drawn_unit(fit, unit, replicate);
    const SeriesCurves curves(runs, candidates,
                              likelihood::weights_of_other_runs(runs.size(), replicate, kOthers));
    const SeriesGains gains = gains_of(blocks, curves, candidates, known,
                                       likelihood::fit_ensemble(blocks, {&curves.base}, known));
    gained.row(r) = gains.values.transpose();
    result.trend[r] = gains.trend;
    result.ln_unit[r] = gains.base.ln_unit;
    for (const SeriesOffset& offset : gains.offsets) {
      const auto q = static_cast<std::size_t>(offset.quantity);
      result.levels[q] += std::pow(offset.level_deviations, 2);
      result.slopes[q] += std::pow(offset.slope_deviations, 2);
    }
  }
  for (auto* squares : {&result.levels, &result.slopes})
    for (double& value : *squares) value = std::sqrt(value / replicates);
  result.mean = gained.colwise().mean().transpose().cwiseMax(0.5);
  result.highest = (gained * result.mean.cwiseInverse().asDiagonal()).rowwise().maxCoeff();
  return result;
}

}  // namespace traceraft::selection
