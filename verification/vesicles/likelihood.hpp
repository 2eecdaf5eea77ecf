// How probable measurements are if simulated vesicles tell the truth, whatever the unit of time is.
#pragma once

#include <vector>

#include "verification/vesicles/history.hpp"
#include "verification/vesicles/measurements.hpp"

namespace traceraft {

// Mean and variance over runs of the logarithms of perimeter and number of rafts, on a grid of ln
// t. The variance is smoothed over a factor of 2 in t: a few runs know it badly.
class RunStatistics {
 public:
  // At least two runs, with times > 0 in any unit. `sample`: which runs, with repetition.
  RunStatistics(const std::vector<History>& runs, const std::vector<int>& sample);

  struct Normal {
    double mean, variance;
  };
  // Constant beyond the ends. Perimeter or rafts only.
  Normal at(Quantity quantity, double t) const;
  double last_time() const;

 private:
  double begin_, step_;  // of ln t
  std::vector<Normal> perimeter_, rafts_;
};

// The simulations do not know D: it only sets the unit of time, R²/D. Nor do they know the scatter
// that measuring adds to the logarithm of a perimeter. Both are found at no cost.
struct TimeFit {
  double seconds_per_unit;  // of the time of the runs
  double scatter;
  double deviance;  // −2 ln of the likelihood, up to a constant of the data
};

// `start`: seconds per unit to begin with; the fit stays within a factor of `range` of it.
// `sample`: which vesicles, with repetition.
TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, double start, double range);

}  // namespace traceraft
