// The law c (t − t0)^b of perimeters, as microscopists fit it.
#pragma once

#include <optional>

#include "verification/observations/history.hpp"
#include "verification/observations/measurements.hpp"
#include "verification/statistics/bootstrap.hpp"
#include "verification/statistics/power_law.hpp"

namespace traceraft::observations {

// The law with its 95 % intervals by the bootstrap over vesicles, or over runs, widened for few.
struct FittedLaw {
  statistics::PowerLaw law;
  statistics::Interval c, t0, b;
  bool t0_open;  // the interval of t0 begins where the search for it ends
  int points, vesicles;
};
// Perimeters over radius within the window. Nothing if they are fewer than four, or of fewer than
// three vesicles.
std::optional<FittedLaw> fit_measurements(const MeasuredVesicles& data,
                                          const statistics::Window& window);
// The geometric mean over the runs at `times` within the window. Nothing likewise.
std::optional<FittedLaw> fit_runs(const std::vector<History>& runs,
                                  const std::vector<double>& times,
                                  const statistics::Window& window);

}  // namespace traceraft::observations
