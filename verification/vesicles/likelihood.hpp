// How probable measurements are if simulated vesicles tell the truth, whatever the unit of time is.
#pragma once

#include <vector>

#include "verification/measure/fit.hpp"
#include "verification/vesicles/history.hpp"
#include "verification/vesicles/measurements.hpp"

namespace traceraft {

// The scatter between vesicles of one kind: the variance of a logarithm is a + b (N − 1)/N² where
// there are N rafts on average, which independent rafts have for large N and a single one for N
// = 1.
struct ScatterLaw {
  double a = 0, b = 0;
  double variance(double rafts) const;
};
struct ScatterLaws {
  ScatterLaw perimeter, rafts;
};
// From the runs at all choices of parameters together: a few runs alone know it badly.
ScatterLaws scatter_laws(const std::vector<std::vector<History>>& ensembles);

// Mean over runs of the logarithms of perimeter and number of rafts, on a grid of ln t.
class RunStatistics {
 public:
  // At least two runs, with times > 0 in any unit. `sample`: which runs, with repetition.
  RunStatistics(const std::vector<History>& runs, const std::vector<int>& sample,
                const ScatterLaws& scatter);
  RunStatistics(const std::vector<History>& runs, const std::vector<int>& sample,
                const ScatterLaws& scatter, const std::vector<double>& times);

  struct Normal {
    double mean, variance;  // variance: of one vesicle, and of the mean itself
  };
  // Constant beyond the ends. Perimeter or rafts only.
  Normal at(Quantity quantity, double t) const;

 private:
  struct Curve {
    std::vector<double> mean, variance;
  };
  LogTimes grid_;
  Curve perimeter_, rafts_;
};

// The simulations do not know D: it only sets the unit of time, R²/D. Nor do they know the scatter
// that measuring adds to the logarithm of a perimeter. Both are found at no cost.
struct TimeFit {
  double seconds_per_unit;  // of the time of the runs
  double scatter;
  double deviance;  // −2 ln of the likelihood, up to a constant of the data
};

// R²/D in seconds: where to begin, and what it may be.
struct TimeUnit {
  double start;
  Interval allowed;
};

// `sample`: which vesicles, with repetition. The uncertainties that the data state are part of the
// scatter of measuring.
TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, const TimeUnit& unit);
// From the fit of data and runs that differ little.
TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, const TimeUnit& unit, const TimeFit& near);

}  // namespace traceraft
