// How probable measurements are if simulated vesicles tell the truth, whatever the unit of time is.
#pragma once

#include <vector>

#include "kernel/core/types.hpp"
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

// Runs at times evenly spaced in ln t, in any unit: the logarithms of perimeter and number of
// rafts, and the raft fraction; a row for each of the times, a column for each run.
struct SampledRuns {
  std::vector<double> times;
  Eigen::MatrixXd perimeter, rafts, fraction;

  SampledRuns(const std::vector<History>& runs, std::vector<double> times);
};

// Means of them over runs.
class RunStatistics {
 public:
  // At least two runs. `sample`: which ones, with repetition.
  RunStatistics(const SampledRuns& runs, const std::vector<int>& sample,
                const ScatterLaws& scatter);
  // Σ weights[k] × means of the k-th, all of as many runs at the same times.
  static RunStatistics combined(const std::vector<RunStatistics>& all,
                                const std::vector<double>& weights);

  // Variances: of one vesicle's logarithms, and of their means themselves.
  struct AtTime {
    double ln_perimeter, perimeter_variance, ln_rafts, rafts_variance;
  };
  // Constant beyond the ends.
  AtTime at(double ln_t) const;
  double fraction(double t) const;

 private:
  struct Means {
    std::vector<double> perimeter, rafts, fraction;
  };

  LogTimes grid_;
  ScatterLaws scatter_;
  double of_mean_;  // variance of one vesicle and of the mean over that of one vesicle
  Means mean_;
};

// Of measuring, that is looked for.
inline constexpr double kLeastScatter = 0.01;

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
// Of deviances, a standard deviation where they are parabolas.
inline constexpr double kAboutAsProbable = 1;
// Units of time, from the shortest to the longest, by which the data are about as probable as by
// `fit`, at its scatter: where curves are flat, these are many.
Interval as_probable(const MeasuredVesicles& data, const std::vector<int>& sample,
                     const RunStatistics& runs, const TimeUnit& unit, const TimeFit& fit);
// From the fit of data and runs that differ little.
TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, const TimeUnit& unit, const TimeFit& near);

}  // namespace traceraft
