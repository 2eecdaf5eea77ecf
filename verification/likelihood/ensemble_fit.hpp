// How probable observations of vesicles are if simulated vesicles tell the truth: the likelihood of
// what was counted and measured at a few looks, with the unit of time, all scatter and the strength
// of an effect free. Simulations do not know D: it only sets the unit of time, R²/D.
#pragma once

#include <vector>

#include "verification/likelihood/observations.hpp"
#include "verification/statistics/bootstrap.hpp"

namespace traceraft::likelihood {

// The model with an effect of strength a has the logarithms mean + a (changed − mean).
struct EnsembleModel {
  const RunCurves* base;
  const RunCurves* changed = nullptr;  // with the effect at strength 1; none: the base alone
  bool two_sided = true;

  // The logarithm at a time (in units of the runs) with the effect at that amplitude.
  double mean(observations::Quantity quantity, double ln_t, double amplitude) const {
    return base->mean(quantity, ln_t) + amplitude * response(quantity, ln_t);
  }
  // Its derivatives by the amplitude and by ln t.
  double response(observations::Quantity quantity, double ln_t) const {
    return changed == nullptr ? 0 : changed->mean(quantity, ln_t) - base->mean(quantity, ln_t);
  }
  double slope(observations::Quantity quantity, double ln_t, double amplitude) const {
    const double slope = base->slope(quantity, ln_t);
    return changed == nullptr ? slope
                              : slope + amplitude * (changed->slope(quantity, ln_t) - slope);
  }
};

// The largest amplitude of an effect in a fit, over that which has been simulated.
inline constexpr double kLargestAmplitude = 2;

struct EnsembleFit {
  double ln_unit = 0;    // of R²/D in seconds
  double amplitude = 0;  // a
  double deviation = 0;  // of a; 0 if there is no effect
  ObservationScatter scatter;
  double deviance = 0;  // −2 ln of the likelihood, and of what was known of the unit

  double seconds_per_unit() const;
  // Standard deviation of ln of one look beyond that of the runs, between vesicles and looks.
  double scatter_beyond_runs(observations::Quantity quantity) const;
};

// R²/D in seconds, by which the time of the runs is multiplied: what is known of it before.
struct UnitPrior {
  double start;                  // where a fit begins, and the median of what is known
  double deviation;              // standard deviation of ln of the unit; infinite: nothing is known
  statistics::Interval allowed;  // where a fit may end
  double drawn = 0;  // in data that are drawn: ln of what is said to be known, over start

  // The unit is within the factor with 95 % confidence. A fit may end within the `reach`-th power
  // of it.
  static UnitPrior within_factor(double start, double factor, double reach = 1);
  // Each ln of the unit in the interval is as probable as any other.
  static UnitPrior uniform(double start, const statistics::Interval& allowed);
  // ln of `allowed`.
  double lowest() const;
  double highest() const;
  // −2 ln of the probability density, up to a constant.
  double deviance(double ln_unit) const;
  double slope(double ln_unit) const;  // its derivative
};
EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit);
// From the fit of a model that differs little.
EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit, const EnsembleFit& near);

// Difference of deviances, a standard deviation where they are parabolas.
inline constexpr double kAboutAsProbable = 1;
// Units of time (s), from the shortest to the longest, by which the data are about as probable as
// by `fit`, at its scatter: where curves are flat, these are many.
statistics::Interval as_probable(const std::vector<ObservedSeries>& blocks,
                                 const EnsembleModel& model, const UnitPrior& unit,
                                 const EnsembleFit& fit);

// The model, an entry per look.
Vec expected(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
             const EnsembleFit& fit);
// The metric in which looks scatter around the model.
ObservationMetric metric_of(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                            const EnsembleFit& fit);
// Measured minus what the model and errors like the stated ones make of it on average, an entry per
// look.
Vec residual(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
             const EnsembleFit& fit);
// Changed − mean, or the derivative of the mean by ln of the unit of time, an entry per look.
Vec response(const std::vector<ObservedSeries>& blocks, const RunCurves& base,
             const RunCurves& changed, double ln_unit);
Vec unit_response(const std::vector<ObservedSeries>& blocks, const RunCurves& base, double ln_unit);

}  // namespace traceraft::likelihood
