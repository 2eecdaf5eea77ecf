// The misfit of series: what a fit of them leaves unexplained.
#pragma once

#include <vector>

#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft::selection {

// The part of a fit's residual that polynomials of ln t explain, a cubic for each quantity, in
// squares of standard deviations.
double trend_left(const std::vector<likelihood::ObservedSeries>& blocks,
                  const likelihood::EnsembleModel& model, const likelihood::EnsembleFit& fit);

// The offset of the logarithms of measurements of a quantity from a fit.
struct SeriesOffset {
  observations::Quantity quantity;
  double level,          // on average
      level_deviations,  // the same in standard deviations
      slope,             // per e-fold of time
      slope_deviations;  // the same in standard deviations
};
// The offsets of the quantities that were measured.
std::vector<SeriesOffset> offsets(const std::vector<likelihood::ObservedSeries>& blocks,
                                  const likelihood::EnsembleModel& model,
                                  const likelihood::EnsembleFit& fit);

}  // namespace traceraft::selection
