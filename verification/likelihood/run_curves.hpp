// What simulated vesicles do on average, as functions of time, and how one of them scatters around
// that.
#pragma once

#include <array>
#include <vector>

#include "kernel/core/types.hpp"
#include "verification/vesicles/history.hpp"

namespace traceraft {

// A number per time for each quantity, in the order of kQuantities.
using QuantityCurves = std::array<std::vector<double>, kQuantities.size()>;

// How runs scatter around their mean: unbiased variances, and the correlation of two logarithms of
// one run at times that differ by a factor e. At a factor e^x it is taken as its x-th power.
struct RunScatter {
  QuantityCurves variance;
  std::array<double, kQuantities.size()> correlation;
};

// Logarithms of runs at times that are evenly spaced in ln t.
class RunSamples {
 public:
  RunSamples(const std::vector<History>& runs, std::vector<double> times);

  const std::vector<double>& times() const { return times_; }
  // `sample`: indices of runs, with repetition.
  QuantityCurves means(const std::vector<int>& sample) const;
  // `sample`: at least two runs.
  RunScatter scatter(const std::vector<int>& sample) const;

 private:
  std::vector<double> times_;
  std::array<Eigen::MatrixXd, kQuantities.size()> values_;  // a row per time, a column per run
};

// Curves of the logarithm of each quantity: linear in ln t, constant beyond the ends.
class RunCurves {
 public:
  // `runs`: at least two that have times > 0 in common. `sample`: which of them, with repetition.
  RunCurves(const std::vector<History>& runs, const std::vector<int>& sample);
  // `scatter`: of one run. `count`: how many runs `mean` is the mean of.
  RunCurves(const std::vector<double>& times, QuantityCurves mean, RunScatter scatter,
            std::size_t count);

  // Σ weights[k] × means of the k-th, with the scatter of the first. All have the same times.
  static RunCurves combined(const std::vector<RunCurves>& all, const std::vector<double>& weights);

  double mean(Quantity quantity, double ln_t) const { return at(mean_, quantity, ln_t); }
  // One more run beside the mean of these: the variance of a run times 1 + 1/count.
  double variance(Quantity quantity, double ln_t) const {
    return at(scatter_.variance, quantity, ln_t);
  }
  // Of two logarithms of one run at times that differ by a factor, whose logarithm is given.
  double correlation(Quantity quantity, double ln_factor) const;
  // The covariance of one more run at several times: a row and a column for each.
  Eigen::MatrixXd covariance(Quantity quantity, const Vec& ln_t) const;
  // The derivative of the mean by ln t.
  double slope(Quantity quantity, double ln_t) const;

 private:
  double at(const QuantityCurves& curves, Quantity quantity, double ln_t) const {
    return grid_.at(curves[static_cast<std::size_t>(quantity)], ln_t);
  }

  LogTimes grid_;
  QuantityCurves mean_;
  RunScatter scatter_;
};

}  // namespace traceraft
