#include "verification/likelihood/ensemble_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backends/nlopt/minimise.hpp"
#include "verification/likelihood/ensemble_likelihood.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

constexpr double kLeastScatter = 0.003, kUsualScatter = 0.1, kLargestScatter = 1;
constexpr int kMostEvaluations = 400;
constexpr double kScatterStep = 0.3, kTolerance = 1e-4;
constexpr double kLeastCurvature = 1e-12;  // where curves are flat, no unit is better than another

constexpr std::size_t index(Quantity quantity) {
  return static_cast<std::size_t>(quantity);
}

// What is free, as a vector of numbers: ln of the unit, the amplitude if there is an effect, and ln
// of the scatter of each quantity that was measured.
class Fitter {
 public:
  Fitter(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
         const UnitPrior& unit)
      : blocks_(blocks), model_(model), unit_(unit), likelihood_(blocks, model, unit) {
    for (const ObservedSeries& block : blocks) measured_[index(block.quantity)] = true;
  }

  // `step`: the first one of ln of the unit.
  EnsembleFit from(const EnsembleFit& start, double step) {
    request_ = {};
    add(std::clamp(start.ln_unit, unit_.lowest(), unit_.highest()), unit_.lowest(), unit_.highest(),
        step);
    if (model_.changed != nullptr)
      add(start.amplitude, model_.two_sided ? -kLargestAmplitude : 0.0, kLargestAmplitude, step);
    const double low = std::log(kLeastScatter), high = std::log(kLargestScatter);
    for (const Quantity quantity : kQuantities) {
      if (!measured_[index(quantity)]) continue;
      add(std::log(start.scatter.vesicle[index(quantity)]), low, high, kScatterStep);
      add(std::log(start.scatter.look[index(quantity)]), low, high, kScatterStep);
    }
    EnsembleFit at = start;
    request_.function = [&](const std::vector<double>& x) {
      set(x, at);
      return likelihood_.deviance(at);
    };
    request_.tolerance = kTolerance;
    request_.most_evaluations = kMostEvaluations;
    request_.smooth = true;
    const Minimum found = minimise(request_);
    set(found.x, at);
    at.deviance = found.value;
    if (model_.changed != nullptr) at.deviation = deviation(at);
    return at;
  }

 private:
  void add(double start, double lower, double upper, double step) {
    request_.start.push_back(std::clamp(start, lower, upper));
    request_.lower.push_back(lower);
    request_.upper.push_back(upper);
    request_.step.push_back(std::min(step, 0.4 * (upper - lower)));
  }

  void set(const std::vector<double>& x, EnsembleFit& fit) const {
    auto next = x.begin();
    fit.ln_unit = *next++;
    if (model_.changed != nullptr) fit.amplitude = *next++;
    for (const Quantity quantity : kQuantities) {
      if (!measured_[index(quantity)]) continue;
      fit.scatter.vesicle[index(quantity)] = std::exp(*next++);
      fit.scatter.look[index(quantity)] = std::exp(*next++);
    }
  }

  // Of the amplitude, from the curvature of the deviance, whatever the unit is.
  double deviation(const EnsembleFit& fit) const {
    const ObservationMetric metric = metric_of(blocks_, model_, fit);
    const Vec u = unit_response(blocks_, *model_.base, fit.ln_unit);
    const Vec e = response(blocks_, *model_.base, *model_.changed, fit.ln_unit);
    const double known = 1 / (unit_.deviation * unit_.deviation);
    const double uu = std::max(metric.product(u, u) + known, kLeastCurvature);
    const double ue = metric.product(u, e);
    return 1 / std::sqrt(metric.product(e, e) + kLeastCurvature - ue * ue / uu);
  }

  const std::vector<ObservedSeries>& blocks_;
  const EnsembleModel& model_;
  const UnitPrior& unit_;
  const EnsembleLikelihood likelihood_;
  std::array<bool, kQuantities.size()> measured_{};
  MinimiseRequest request_;
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
    const EnsembleFit fit = fitter.from(start, 0.4);
    if (fit.deviance < best.deviance) best = fit;
  }
  return best;
}

EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit, const EnsembleFit& near) {
  return Fitter(blocks, model, unit).from(near, 0.1);
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
