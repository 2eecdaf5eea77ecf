#include "verification/series/series_gains.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/random.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

// Streams of random numbers.
enum SeriesStream : std::uint64_t {
  kRunOf = 1,
  kVesicle = 2,
  kLook = 3,
  kSample = 4,
  kStated = 5,
  kUnit = 6
};
constexpr std::uint64_t kNext = 1ull << 32;  // number of one look

// The same looks at vesicles of the base model, one run each.
MeasuredVesicles draw_base(const MeasuredVesicles& data, const StatedErrors& errors,
                           const std::vector<History>& runs, const EnsembleFit& fit,
                           std::uint64_t replicate) {
  MeasuredVesicles drawn_data = data;
  std::uint64_t vesicle = 0, look = 0;
  for (const auto& [first, last] : data.vesicles()) {
    const History& run = runs[static_cast<std::size_t>(
        random_index(static_cast<int>(runs.size()), replicate, kRunOf, vesicle))];
    for (std::size_t i = first; i < last; ++i)
      for (const Quantity quantity : kQuantities) {
        const auto q = static_cast<std::size_t>(quantity);
        ++look;
        const double measured = data.measurements[i].of(quantity).value_or(0);
        if (!(measured > 0)) continue;  // it says nothing
        const double t = data.measurements[i].time / std::exp(fit.ln_unit);
        double& value = drawn_data.measurements[i].values[q].emplace(0);
        if (run.at(Quantity::rafts, t) < 1) continue;
        const Measurement& m = data.measurements[i];
        const double own =
            logarithm_of(quantity, run.at(quantity, t)) +
            fit.scatter.vesicle[q] * normal_random(replicate, kVesicle, 3 * vesicle + q) +
            fit.scatter.look[q] * normal_random(replicate, kLook, look);
        value = std::exp(errors.of(m, quantity).drawn(own, [&](std::uint64_t k) {
          return normal_random(replicate, kStated, look + k * kNext);
        }));
        if (quantity == Quantity::rafts) value = std::max(1.0, std::round(value));
        drawn_data.measurements[i].sigma[q] =
            m.sigma_of(quantity) * std::pow(value / measured, errors.power(quantity));
      }
    ++vesicle;
  }
  return drawn_data;
}

// What is known of D before is a measurement, too. The fit ends where it did: with other ends the
// data of some sets would lie beyond them.
UnitPrior draw_unit(const EnsembleFit& fit, const UnitPrior& unit, std::uint64_t replicate) {
  UnitPrior drawn = unit;
  drawn.drawn =
      fit.ln_unit - std::log(unit.start) + unit.deviation * normal_random(replicate, kUnit, 0);
  return drawn;
}

}  // namespace

SeriesCurves::SeriesCurves(const std::vector<History>& runs,
                           const std::vector<SeriesCandidate>& candidates,
                           const std::vector<int>& sample)
    : base(runs, sample) {
  for (const SeriesCandidate& candidate : candidates) changed.emplace_back(candidate.runs, sample);
}

SeriesGains gains_of(const MeasuredVesicles& data, const SeriesCurves& curves,
                     const std::vector<SeriesCandidate>& candidates, const UnitPrior& unit) {
  const std::vector<ObservedSeries> blocks = observed_series(data);
  SeriesGains gains;
  gains.base = fit_ensemble(blocks, {&curves.base}, unit);
  gains.trend = trend_left(blocks, {&curves.base}, gains.base);
  gains.offsets = offsets(blocks, {&curves.base}, gains.base);
  gains.values.resize(static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    gains.fits.push_back(fit_ensemble(
        blocks, {&curves.base, &curves.changed[k], candidates[k].two_sided}, unit, gains.base));
    gains.values[static_cast<Eigen::Index>(k)] =
        std::max(0.0, gains.base.deviance - gains.fits[k].deviance);
  }
  return gains;
}

// Data of the base model, fitted with curves of resampled runs, which hold a third of the runs
// that data come from not at all and others more than once.
SeriesNull null_of(const MeasuredVesicles& data, const std::vector<History>& runs,
                   const std::vector<SeriesCandidate>& candidates, const EnsembleFit& fit,
                   const UnitPrior& unit, int replicates) {
  SeriesNull result;
  const StatedErrors errors(data);
  const auto count = static_cast<Eigen::Index>(candidates.size());
  Eigen::MatrixXd gained(replicates, count);
  result.trend.resize(replicates);
  result.ln_unit.resize(replicates);
  for (int r = 0; r < replicates; ++r) {
    const auto replicate = static_cast<std::uint64_t>(r + 1);
    const std::vector<int> sample = resample(static_cast<int>(runs.size()), replicate, kSample);
    const SeriesGains gains =
        gains_of(draw_base(data, errors, runs, fit, replicate), {runs, candidates, sample},
                 candidates, draw_unit(fit, unit, replicate));
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

}  // namespace traceraft
