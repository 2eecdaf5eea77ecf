#include "verification/likelihood/ensemble_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/likelihood/ensemble_likelihood.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

using Kind = FreeParameter::Kind;

constexpr double kLeastScatter = 0.003, kUsualScatter = 0.1, kLargestScatter = 1;
constexpr int kMostIterations = 60;
constexpr double kTolerance = 1e-5;  // of the deviance
constexpr double kHardlyDamped = 1e-2, kMostDamping = 1e6;
constexpr double kLongestStep = 1, kRoundoff = 1e-9;
constexpr double kLeastCurvature = 1e-12;  // where curves are flat, no unit is better than another

constexpr std::size_t index(Quantity quantity) {
  return static_cast<std::size_t>(quantity);
}

// Fisher's scoring: Newton's method with the expected second derivatives, damped as Levenberg and
// Marquardt do until the deviance falls, within bounds.
class Fitter {
 public:
  Fitter(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
         const UnitPrior& unit)
      : likelihood_(blocks, model, unit) {
    add({Kind::unit}, unit.lowest(), unit.highest());
    if (model.changed != nullptr)
      add({Kind::amplitude}, model.two_sided ? -kLargestAmplitude : 0.0, kLargestAmplitude);
    for (const Quantity quantity : kQuantities) {
      if (std::none_of(blocks.begin(), blocks.end(),
                       [&](const ObservedSeries& block) { return block.quantity == quantity; }))
        continue;
      for (const Kind kind : {Kind::vesicle_scatter, Kind::look_scatter})
        add({kind, quantity}, std::log(kLeastScatter), std::log(kLargestScatter));
    }
  }

  EnsembleFit from(EnsembleFit fit) const {
    for (std::size_t p = 0; p < free_.size(); ++p) free_[p].set(bounded(p, free_[p].get(fit)), fit);
    double damping = 1e-3;
    DevianceExpansion here = likelihood_.expand(fit, free_);
    for (int k = 0; k < kMostIterations; ++k) {
      const EnsembleFit next = moved(fit, step(here, fit, damping));
      const double deviance = likelihood_.deviance(next);
      if (deviance < here.value) {
        const double gain = here.value - deviance;
        fit = next;
        here = likelihood_.expand(fit, free_);
        damping = std::max(0.1 * damping, 1e-6);
        if (gain < kTolerance && damping < kHardlyDamped) break;  // a damped step may be short
      } else {
        damping *= 8;
        if (damping > kMostDamping) break;
      }
    }
    fit.deviance = here.value;
    fit.deviation = deviation(here);
    return fit;
  }

 private:
  void add(const FreeParameter& parameter, double low, double high) {
    free_.push_back(parameter);
    bounds_.push_back({low, high});
  }

  double bounded(std::size_t p, double value) const {
    return std::clamp(value, bounds_[p].low, bounds_[p].high);
  }

  EnsembleFit moved(EnsembleFit fit, const Vec& by) const {
    for (std::size_t p = 0; p < free_.size(); ++p)
      free_[p].set(bounded(p, free_[p].get(fit) + by[static_cast<Eigen::Index>(p)]), fit);
    return fit;
  }

  // What would leave its bounds stays where it is.
  Vec step(const DevianceExpansion& here, const EnsembleFit& fit, double damping) const {
    Vec gradient = here.gradient;
    Eigen::MatrixXd hessian = here.hessian;
    hessian.diagonal() *= 1 + damping;
    hessian.diagonal().array() += kLeastCurvature;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const auto p = static_cast<Eigen::Index>(i);
      const double value = free_[i].get(fit), edge = kRoundoff * (bounds_[i].high - bounds_[i].low);
      const bool leaves =
          gradient[p] > 0 ? value < bounds_[i].low + edge : value > bounds_[i].high - edge;
      if (!leaves) continue;
      gradient[p] = 0;
      hessian.row(p).setZero();
      hessian.col(p).setZero();
      hessian(p, p) = 1;
    }
    const Vec newton = -hessian.ldlt().solve(gradient);
    const double longest = newton.cwiseAbs().maxCoeff();
    return longest > kLongestStep ? Vec(kLongestStep / longest * newton) : newton;
  }

  // Of the amplitude, whatever the unit is; the scatter is independent of both.
  double deviation(const DevianceExpansion& here) const {
    if (free_.size() < 2 || free_[1].kind != Kind::amplitude) return 0;
    const Eigen::MatrixXd& h = here.hessian;
    const double own = h(1, 1) - h(0, 1) * h(0, 1) / std::max(h(0, 0), kLeastCurvature);
    return std::sqrt(2 / std::max(own, kLeastCurvature));
  }

  const EnsembleLikelihood likelihood_;
  std::vector<FreeParameter> free_;
  std::vector<Interval> bounds_;
};

}  // namespace

UnitPrior UnitPrior::within_factor(double start, double factor, double reach) {
  const double most = std::pow(factor, reach);
  return {start, std::log(factor) / kNormal95, {start / most, start * most}};
}

UnitPrior UnitPrior::uniform(double start, const Interval& allowed) {
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

double EnsembleFit::scatter_beyond_runs(Quantity quantity) const {
  return std::hypot(scatter.vesicle[index(quantity)], scatter.look[index(quantity)]);
}

EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit) {
  Fitter fitter(blocks, model, unit);
  EnsembleFit best, start;
  best.deviance = std::numeric_limits<double>::infinity();
  start.scatter.vesicle.fill(kUsualScatter);
  start.scatter.look.fill(kUsualScatter);
  const double middle = std::log(unit.start);
  // Several starts: where a plateau is reached, time makes no difference.
  for (const double ln_unit :
       {0.5 * (unit.lowest() + middle), middle, 0.5 * (middle + unit.highest())}) {
    start.ln_unit = ln_unit;
    const EnsembleFit fit = fitter.from(start);
    if (fit.deviance < best.deviance) best = fit;
  }
  return best;
}

EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit, const EnsembleFit& near) {
  return Fitter(blocks, model, unit).from(near);
}

Interval as_probable(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                     const UnitPrior& unit, const EnsembleFit& fit) {
  constexpr int kUnits = 200;
  const double low = unit.lowest(), high = unit.highest();
  const EnsembleLikelihood likelihood(blocks, model, unit);
  const double most = likelihood.deviance(fit) + kAboutAsProbable;
  EnsembleFit at = fit;
  Interval range{fit.ln_unit, fit.ln_unit};
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
  return per_look(blocks, [&](const ObservedSeries& block, Eigen::Index i) {
    return model.mean(block.quantity, block.ln_t[i] - fit.ln_unit, fit.amplitude);
  });
}

ObservationMetric metric_of(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                            const EnsembleFit& fit) {
  return {blocks, known_covariance(blocks, *model.base, fit.ln_unit, expected(blocks, model, fit)),
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

}  // namespace traceraft
