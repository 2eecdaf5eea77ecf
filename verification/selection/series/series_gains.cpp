#include "verification/selection/series/series_gains.hpp"

#include <algorithm>
#include <cmath>

#include "verification/likelihood/drawn_vesicles.hpp"
#include "verification/selection/fit/score_test.hpp"

namespace traceraft::selection {
namespace {

constexpr std::uint64_t kOthers = 4;  // stream of random numbers

std::vector<double> times_of_all(const std::vector<observations::History>& runs,
                                 const std::vector<SeriesCandidate>& candidates) {
  std::vector<observations::History> all = runs;
  for (const SeriesCandidate& candidate : candidates)
    for (const SeriesLevel& level : candidate.levels)
      all.insert(all.end(), level.runs.begin(), level.runs.end());
  return observations::common_times(all, observations::kCurveTimes);
}

}  // namespace

SeriesSamples::SeriesSamples(const std::vector<observations::History>& runs,
                             const std::vector<SeriesCandidate>& candidates)
    : base(runs, times_of_all(runs, candidates)) {
  for (const SeriesCandidate& candidate : candidates) {
    levels.emplace_back();
    for (const SeriesLevel& level : candidate.levels)
      levels.back().emplace_back(level.runs, base.times());
  }
}

SeriesCurves::SeriesCurves(const SeriesSamples& samples,
                           const std::vector<SeriesCandidate>& candidates)
    : base(samples.base) {
  for (const auto& some : samples.levels) levels_.emplace_back(some.begin(), some.end());
  for (const SeriesCandidate& candidate : candidates) two_sided_.push_back(candidate.two_sided);
}

SeriesCurves::SeriesCurves(const SeriesSamples& samples,
                           const std::vector<SeriesCandidate>& candidates,
                           const Eigen::MatrixXd& weights)
    : base(samples.base.others(weights)) {
  for (const auto& some : samples.levels) {
    levels_.emplace_back();
    for (const likelihood::RunSamples& runs : some)
      levels_.back().emplace_back(runs.others(weights));
  }
  for (const SeriesCandidate& candidate : candidates) two_sided_.push_back(candidate.two_sided);
}

likelihood::EnsembleModel SeriesCurves::with(std::size_t candidate) const {
  std::vector<const likelihood::RunCurves*> levels;
  for (const likelihood::RunCurves& curves : levels_[candidate]) levels.push_back(&curves);
  return {&base, std::move(levels), two_sided_[candidate]};
}

SeriesGains gains_of(const std::vector<likelihood::ObservedSeries>& blocks,
                     const SeriesCurves& curves, std::size_t candidates,
                     const likelihood::UnitPrior& unit, const likelihood::EnsembleFit& base) {
  SeriesGains gains;
  gains.base = base;
  gains.trend = trend_left(blocks, {&curves.base}, gains.base);
  gains.offsets = offsets(blocks, {&curves.base}, gains.base);
  gains.values.resize(static_cast<Eigen::Index>(candidates));
  for (std::size_t k = 0; k < candidates; ++k) {
    gains.fits.push_back(likelihood::fit_ensemble(blocks, curves.with(k), unit, gains.base));
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
  const SeriesSamples samples(runs, candidates);
  Eigen::MatrixXd& gained = result.gains;
  gained.resize(replicates, count);
  result.trend.resize(replicates);
  result.ln_unit.resize(replicates);
  for (int r = 0; r < replicates; ++r) {
    const auto replicate = static_cast<std::uint64_t>(r + 1);
    const std::vector<likelihood::ObservedSeries> blocks = likelihood::observed_series(
        likelihood::drawn_vesicles(data, errors, {&runs}, fit, replicate));
    const likelihood::UnitPrior known = likelihood::drawn_unit(fit, unit, replicate);
    const SeriesCurves curves(samples, candidates,
                              likelihood::weights_of_other_runs(runs.size(), replicate, kOthers));
    const SeriesGains gains = gains_of(blocks, curves, candidates.size(), known,
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
  return result;
}

SeriesSurprise surprise_of(const Vec& gains, const SeriesNull& null) {
  constexpr double kLeast = 1e-300;
  const Eigen::Index replicates = null.gains.rows();
  SeriesSurprise result{Vec(gains.size()), Vec::Zero(replicates)};
  for (Eigen::Index k = 0; k < gains.size(); ++k) {
    Vec all(replicates + 1);
    all << null.gains.col(k), gains[k];
    const auto surprise = [&](double gain) {
      return -std::log(std::max(gamma_tail(all, gain), kLeast));
    };
    result.data[k] = surprise(gains[k]);
    for (Eigen::Index r = 0; r < replicates; ++r)
      result.highest[r] = std::max(result.highest[r], surprise(null.gains(r, k)));
  }
  return result;
}

}  // namespace traceraft::selection
