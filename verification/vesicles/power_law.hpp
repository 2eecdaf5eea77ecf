// The law of coarsening as microscopists fit it: c (t − t0)^b.
#pragma once

#include <optional>

#include "verification/measure/fit.hpp"
#include "verification/vesicles/history.hpp"
#include "verification/vesicles/measurements.hpp"

namespace traceraft {

struct PowerLaw {
  double c, t0, b;
  double scatter;  // standard deviation of ln y about it
  double at(double t) const;
};
// Least squares of ln y, t0 between −10 times the first t and just before it. At least four points
// with t, y > 0.
PowerLaw fit_power_law_from(const Points& points);

// The law with its 95 % intervals by the bootstrap over vesicles, or over runs, widened for few.
struct FittedLaw {
  PowerLaw law;
  Interval c, t0, b;
  bool t0_open;  // the interval of t0 begins where the search for it ends
  int points, vesicles;
};
// Perimeters over radius within the window. Nothing if they are fewer than four, or of fewer than
// three vesicles.
std::optional<FittedLaw> fit_measurements(const MeasuredVesicles& data, const Window& window);
// The geometric mean over the runs at `times` within the window. Nothing likewise.
std::optional<FittedLaw> fit_runs(const std::vector<History>& runs,
                                  const std::vector<double>& times, const Window& window);

}  // namespace traceraft
