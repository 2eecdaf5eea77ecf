// The range of D that series allow if an effect may be at work that they do not exclude.
#pragma once

#include <string>
#include <vector>

#include "verification/selection/series/series_gains.hpp"

namespace traceraft::selection {

struct UnitRange {
  double low, high;  // ln of R²/D in seconds, 95 %
  // The effects that make it as wide; empty: none is needed.
  std::string low_by, high_by;
  bool low_open, high_open;  // it ends where the fit may not go further
};

// Of all effects in `candidates` by number, at any strength with which the data are about as
// probable as with the best one. `widening`: of the standard deviations of ln of the unit, as runs
// are few.
UnitRange unit_range(const std::vector<likelihood::ObservedSeries>& blocks,
                     const SeriesCurves& curves, const std::vector<SeriesCandidate>& candidates,
                     const std::vector<std::size_t>& numbers, const SeriesGains& gains,
                     const Vec& null_means, const likelihood::UnitPrior& unit, double widening);

}  // namespace traceraft::selection
