// How probable series of vesicles are if simulated vesicles tell the truth: the likelihood of what
// was counted and measured at a few looks, with the unit of time, all scatter and the strength of
// an effect free.
#pragma once

#include <vector>

#include "verification/series/series_metric.hpp"

namespace traceraft {

// The model with an effect of strength a has the logarithms mean + a (changed − mean).
struct SeriesModel {
  const RunCurves* base;
  const RunCurves* changed = nullptr;  // with the effect at strength 1; none: the base alone
  bool two_sided = true;
};

// Of an effect, over what has been simulated: a fit does not leave that either.
inline constexpr double kLargestAmplitude = 2;

struct SeriesFit {
  double ln_unit = 0;    // of R²/D in seconds
  double amplitude = 0;  // a
  double deviation = 0;  // of a; 0 if there is no effect
  SeriesScatter scatter;
  double deviance;  // −2 ln of the likelihood
};

// Seconds per unit of time: what is known of it before, with 95 % confidence within a factor. The
// fit does not leave that (or `reach`), nor what is at least needed for runs to last as long as the
// data.
struct UnitRange {
  double start, factor;
  double least = 0;
  double reach = 1;  // of the fit, beyond the factor if larger than 1: a power of it
  double drawn = 0;  // in data that are drawn: ln of what is said to be known, over start

  double deviation() const;  // of ln of the unit, before
  // Of ln of the unit, where a fit may end.
  double lowest() const;
  double highest() const;
};
SeriesFit fit_series(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                     const UnitRange& unit);
// From the fit of a model that differs little.
SeriesFit fit_series(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                     const UnitRange& unit, const SeriesFit& near);

// With an entry per look: the model.
Vec expected(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
             const SeriesFit& fit);
// In which looks scatter around it.
SeriesMetric metric_of(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                       const SeriesFit& fit);
// With an entry per look: measured minus what the model and errors like the stated ones make of it
// on average.
Vec residual(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
             const SeriesFit& fit);
// With an entry per look: changed − mean, or the derivative of the mean by ln of the unit of time.
Vec response(const std::vector<SeriesBlock>& blocks, const RunCurves& base,
             const RunCurves& changed, double ln_unit);
Vec unit_response(const std::vector<SeriesBlock>& blocks, const RunCurves& base, double ln_unit);

}  // namespace traceraft
