#include "verification/likelihood/ensemble_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/likelihood/ensemble_likelihood.hpp"
#include "verification/statistics/bootstrap.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::likelihood {
namespace {

constexpr double kUsualScatter = 0.1;
constexpr double kLeastInformation = 1e-12;

// Of ln of the unit and the amplitude; the scatter is independent of both. What nothing is known of
// has a large variance, not an infinite one.
Eigen::Matrix2d covariance_of(const FreeParameters& free, const Eigen::MatrixXd& h) {
  Eigen::Matrix2d result = Eigen::Matrix2d::Zero();
  const double unit = std::max(h(0, 0), kLeastInformation);
  result(0, 0) = 2 / unit;
  if (free.all.size() < 2 || free.all[1].kind != FreeParameter::Kind::amplitude) return result;
  const double slope = h(0, 1) / unit;  // of ln of the unit by the amplitude, but for its sign
  result(1, 1) = 2 / std::max(h(1, 1) - h(0, 1) * slope, kLeastInformation);
  result(0, 1) = result(1, 0) = -slope * result(1, 1);
  result(0, 0) += slope * slope * result(1, 1);
  return result;
}

EnsembleFit fit_from(const EnsembleFit& start, const EnsembleLikelihood& likelihood,
                     const FreeParameters& free) {
  EnsembleFit fit = start;
  const auto at = [&](const Vec& x) -> const EnsembleFit& {
    free.set(x, fit);
    return fit;
  };
  const ScoredMinimum found = minimise_by_scoring(
      {[&](const Vec& x) { return likelihood.expand(at(x), free.all); }, free.lower, free.upper},
      free.get(start));
  free.set(found.x, fit);
  fit.deviance = found.at.value;
  fit.covariance = covariance_of(free, found.at.hessian);
  fit.deviation = std::sqrt(fit.covariance(1, 1));
  return fit;
}

std::vector<Eigen::Index> looks_at(const std::vector<ObservedSeries>& blocks,
                                   observations::Quantity quantity) {
  std::vector<Eigen::Index> result;
  Eigen::Index next = 0;
  for (const ObservedSeries& block : blocks)
    for (Eigen::Index i = 0; i < block.values.size(); ++i, ++next)
      if (block.quantity == quantity) result.push_back(next);
  return result;
}

// The best of fits at each level, from one level to the next. A strong effect may shift the unit in
// proportion to its strength, so that the last shift is repeated.
EnsembleFit best_of_levels(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                           const UnitPrior& unit, const EnsembleFit& near) {
  EnsembleFit best, fit = near;
  best.deviance = std::numeric_limits<double>::infinity();
  double shift = 0;
  for (double a = 1; a <= model.largest_amplitude(); a += 1) {
    const RunCurves curves = model.at(a);
    const EnsembleModel level(&curves);
    const EnsembleLikelihood likelihood(blocks, level, unit);
    const FreeParameters free(blocks, level, unit);
    EnsembleFit here = fit_from(fit, likelihood, free);
    if (shift != 0) {
      EnsembleFit shifted = fit;
      shifted.ln_unit += shift;
      const EnsembleFit other = fit_from(shifted, likelihood, free);
      if (other.deviance < here.deviance) here = other;
    }
    shift = here.ln_unit - fit.ln_unit;
    fit = here;
    fit.amplitude = a;
    if (fit.deviance < best.deviance) best = fit;
  }
  return best;
}

}  // namespace

UnitPrior UnitPrior::within_factor(double start, double factor, double reach) {
  const double most = std::pow(factor, reach);
  return {start, std::log(factor) / statistics::kNormal95, {start / most, start * most}};
}

UnitPrior UnitPrior::uniform(double start, const statistics::Interval& allowed) {
  return {start, std::numeric_limits<double>::infinity(), allowed};
}

double UnitPrior::lowest() const {
  return std::log(allowed.low);
}

double UnitPrior::highest() const {
  return std::log(allowed.high);
}

double UnitPrior::deviance(double ln_unit) const {
  const double off = (ln_unit - std::log(start) - drawn) / deviation;
  return off * off;
}

double UnitPrior::slope(double ln_unit) const {
  return 2 * (ln_unit - std::log(start) - drawn) / (deviation * deviation);
}

double EnsembleFit::seconds_per_unit() const {
  return std::exp(ln_unit);
}

double EnsembleFit::scatter_beyond_runs(observations::Quantity quantity) const {
  return std::hypot(scatter.vesicle[observations::index_of(quantity)],
                    scatter.look[observations::index_of(quantity)]);
}

EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit) {
  const EnsembleLikelihood likelihood(blocks, model, unit);
  const FreeParameters free(blocks, model, unit);
  EnsembleFit best, start;
  best.deviance = std::numeric_limits<double>::infinity();
  start.scatter.vesicle.fill(kUsualScatter);
  start.scatter.look.fill(kUsualScatter);
  const double middle = std::log(unit.start);
  // Several starts: where a plateau is reached, time makes no difference.
  for (const double ln_unit :
       {0.5 * (unit.lowest() + middle), middle, 0.5 * (middle + unit.highest())}) {
    start.ln_unit = ln_unit;
    const EnsembleFit fit = fit_from(start, likelihood, free);
    if (fit.deviance < best.deviance) best = fit;
  }
  return best;
}

EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit, const EnsembleFit& near) {
  const EnsembleLikelihood likelihood(blocks, model, unit);
  const FreeParameters free(blocks, model, unit);
  const EnsembleFit fit = fit_from(near, likelihood, free);
  if (!model.has_several_levels()) return fit;
  const EnsembleFit other = fit_from(best_of_levels(blocks, model, unit, near), likelihood, free);
  return other.deviance < fit.deviance ? other : fit;
}

// A mean that is off by δ moves the fit by P Jᵀ K⁻¹ δ. Here P is the covariance of the fit, J has
// the derivatives of the mean by its parameters, and K is the covariance of the looks. The runs
// that tell δ are few.
EnsembleFit with_error_of_runs(const std::vector<ObservedSeries>& blocks,
                               const EnsembleModel& model, EnsembleFit fit) {
  const RunCurves curves = model.at(fit.amplitude), by = model.by_amplitude(fit.amplitude);
  const ObservationMetric metric = metric_of(blocks, model, fit);
  const Vec ln_t = per_look(blocks, [&](const ObservedSeries& block, Eigen::Index i) {
    return block.ln_t[i] - fit.ln_unit;
  });
  const Vec by_unit = metric.solved(unit_response(blocks, curves, fit.ln_unit)),
            by_amplitude = metric.solved(
                per_look(blocks, ln_t, [&](const ObservedSeries&block, Eigen::Index, double t) {
                  return by.mean(block.quantity, t);
                }));
  Eigen::Matrix2d pulled = Eigen::Matrix2d::Zero();
  for (const observations::Quantity quantity : observations::kQuantities) {
    const std::vector<Eigen::Index> looks = looks_at(blocks, quantity);
    Eigen::MatrixX2d pull(looks.size(), 2);
    pull << by_unit(looks), by_amplitude(looks);
    pulled += pull.transpose() * curves.covariance(quantity, ln_t(looks)) * pull;
  }
  const double student = statistics::student_factor(static_cast<int>(curves.count()));
  fit.covariance +=
      student * student * curves.share_of_mean() * fit.covariance * pulled * fit.covariance;
  fit.deviation = std::sqrt(fit.covariance(1, 1));
  return fit;
}

statistics::Interval as_probable(const std::vector<ObservedSeries>& blocks,
                                 const EnsembleModel& model, const UnitPrior& unit,
                                 const EnsembleFit& fit) {
  constexpr int kUnits = 200;
  const double low = unit.lowest(), high = unit.highest();
  const EnsembleLikelihood likelihood(blocks, model, unit);
  const double most = likelihood.deviance(fit) + kAboutAsProbable;
  EnsembleFit at = fit;
  statistics::Interval range{fit.ln_unit, fit.ln_unit};
  for (int k = 0; k <= kUnits; ++k) {
    at.ln_unit = low + (high - low) * k / kUnits;
    if (likelihood.deviance(at) > most) continue;
    range.low = std::min(range.low, at.ln_unit);
    range.high = std::max(range.high, at.ln_unit);
  }
  return {std::exp(range.low), std::exp(range.high)};
}

Vec expected(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
             const EnsembleFit& fit) {
  const RunCurves curves = model.at(fit.amplitude);
  return per_look(blocks, [&](const ObservedSeries& block, Eigen::Index i) {
    return curves.mean(block.quantity, block.ln_t[i] - fit.ln_unit);
  });
}

ObservationMetric metric_of(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                            const EnsembleFit& fit) {
  return {
      blocks,
      known_covariance(blocks, model.at(fit.amplitude), fit.ln_unit, expected(blocks, model, fit)),
      fit.scatter};
}

Vec residual(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
             const EnsembleFit& fit) {
  return per_look(blocks, expected(blocks, model, fit),
                  [](const ObservedSeries& block, Eigen::Index i, double mean) {
                    return block.values[i] - mean -
                           block.stated[static_cast<std::size_t>(i)].bias(mean);
                  });
}

Vec response(const std::vector<ObservedSeries>& blocks, const RunCurves& base,
             const RunCurves& changed, double ln_unit) {
  return per_look(blocks, [&](const ObservedSeries& block, Eigen::Index i) {
    const double t = block.ln_t[i] - ln_unit;
    return changed.mean(block.quantity, t) - base.mean(block.quantity, t);
  });
}

Vec unit_response(const std::vector<ObservedSeries>& blocks, const RunCurves& base,
                  double ln_unit) {
  return per_look(blocks, [&](const ObservedSeries& block, Eigen::Index i) {
    return -base.slope(block.quantity, block.ln_t[i] - ln_unit);
  });
}

}  // namespace traceraft::likelihood
