// What a fit of series leaves unexplained.
#pragma once

#include <vector>

#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft::selection {

// What is left of a fit that polynomials of ln t explain, a cubic for each quantity, in squares of
// standard deviations.
double trend_left(const std::vector<likelihood::ObservedSeries>& blocks,
                  const likelihood::EnsembleModel& model, const likelihood::EnsembleFit& fit);

// How the logarithms of measurements of a quantity lie beside a fit: on average, and per e-fold of
// time; and in standard deviations.
struct SeriesOffset {
  observations::Quantity quantity;
  double level, level_deviations, slope, slope_deviations;
};
// Of those that were measured.
std::vector<SeriesOffset> offsets(const std::vector<likelihood::ObservedSeries>& blocks,
                                  const likelihood::EnsembleModel& model,
                                  const likelihood::EnsembleFit& fit);

}  // namespace traceraft::selection
