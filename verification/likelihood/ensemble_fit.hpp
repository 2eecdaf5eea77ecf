// How probable observations of vesicles are if simulated vesicles tell the truth: the likelihood of
// what was counted and measured at a few looks, with the unit of time, all scatter and the strength
// of an effect free. Simulations do not know D: it only sets the unit of time, R²/D.
#pragma once

#include <vector>

#include "verification/likelihood/ensemble_model.hpp"
#include "verification/likelihood/observations.hpp"
#include "verification/statistics/bootstrap.hpp"

namespace traceraft::likelihood {

struct EnsembleFit {
  double ln_unit = 0;    // of R²/D in seconds
  double amplitude = 0;  // of the effect
  double deviation = 0;  // of the amplitude, whatever the unit is; 0 if there is no effect
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of ln_unit and amplitude
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
// From the fit of a model that differs little. If the model has several levels, the best fit of
// those at each level is another start.
EnsembleFit fit_ensemble(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                         const UnitPrior& unit, const EnsembleFit& near);

// The fit with a covariance to which the error of the mean of the runs has been added. All vesicles
// are held against the same runs, so that more vesicles do not make it smaller.
EnsembleFit with_error_of_runs(const std::vector<ObservedSeries>& blocks,
                               const EnsembleModel& model, EnsembleFit fit);

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
