// Means of simulated vesicles as functions of time, and how one vesicle scatters around them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/core/types.hpp"
#include "verification/observations/history.hpp"

namespace traceraft::likelihood {

// A number per time for each quantity, in the order of kQuantities.
using QuantityCurves = std::array<std::vector<double>, observations::kQuantities.size()>;

// How runs scatter around their mean: unbiased variances, and the correlation of two logarithms of
// one run at times that differ by a factor e. At a factor e^x it is taken as its x-th power.
struct RunScatter {
  QuantityCurves variance;
  std::array<double, observations::kQuantities.size()> correlation;
};

// Weights of `runs` runs, two at least, that sum to 1. Logarithms weighted by them are those of
// another run of the same kind: normal, with the mean of the runs and their covariance between
// times and between quantities. The `index`-th of such runs.
Vec weights_of_another_run(std::size_t runs, std::uint64_t seed, std::uint64_t stream,
                           std::uint64_t index);
// The weights of `runs` other runs, a column for each.
Eigen::MatrixXd weights_of_other_runs(std::size_t runs, std::uint64_t seed, std::uint64_t stream);

// Logarithms of runs at times that are evenly spaced in ln t.
class RunSamples {
 public:
  RunSamples(const std::vector<observations::History>& runs, std::vector<double> times);

  const std::vector<double>& times() const { return times_; }
  // Samples of other runs; `weights`: a column for each of them.
  RunSamples others(const Eigen::MatrixXd& weights) const;
  QuantityCurves means() const;
  RunScatter scatter() const;  // at least two runs
  std::size_t count() const { return static_cast<std::size_t>(values_.front().cols()); }

 private:
  std::vector<double> times_;
  std::array<Eigen::MatrixXd, observations::kQuantities.size()>
      values_;  // a row per time, a column per run
};

// Functions of ln t by values at times that are evenly spaced in it: quadratic B-splines with the
// values as control points (de Boor, "A Practical Guide to Splines", 1978). They have a continuous
// derivative, which a fit needs, reproduce what is linear, and are constant beyond the ends.
class LogSpline {
 public:
  explicit LogSpline(const std::vector<double>& times);  // at least two
  // `values`: one for each of the times.
  double at(const std::vector<double>& values, double ln_t) const;
  double slope(const std::vector<double>& values, double ln_t) const;

 private:
  // Three neighbouring values, and where ln t is among them, −1/2 to 1/2 steps from the second.
  struct Place {
    double before, here, after, offset;
  };
  Place place(const std::vector<double>& values, double ln_t) const;

  double begin_, step_;
};

// Curves of the logarithm of each quantity.
class RunCurves {
 public:
  // `runs`: at least two that have times > 0 in common.
  explicit RunCurves(const std::vector<observations::History>& runs);
  explicit RunCurves(const RunSamples& samples);
  // `scatter`: of one run. `count`: how many runs `mean` is the mean of.
  RunCurves(const std::vector<double>& times, QuantityCurves mean, RunScatter scatter,
            std::size_t count);

  // Σ means[k] × means of the k-th and Σ variances[k] × its variances, with the correlation of the
  // first. All have the same times.
  static RunCurves combined(const std::vector<const RunCurves*>& all, const Vec& means,
                            const Vec& variances);

  double mean(observations::Quantity quantity, double ln_t) const {
    return spline_.at(mean_[observations::index_of(quantity)], ln_t);
  }
  // One more run beside the mean of these: the variance of a run times 1 + 1/count.
  double variance(observations::Quantity quantity, double ln_t) const {
    return spline_.at(scatter_.variance[observations::index_of(quantity)], ln_t);
  }
  // The correlation of two logarithms of one run at times that differ by a factor, whose logarithm
  // is given.
  double correlation(observations::Quantity quantity, double ln_factor) const;
  // The covariance of one more run at several times: a row and a column for each.
  Eigen::MatrixXd covariance(observations::Quantity quantity, const Vec& ln_t) const;
  // The share of it that is the error of the mean, the same for all runs that are held against it.
  double share_of_mean() const { return 1 / (static_cast<double>(count_) + 1); }
  std::size_t count() const { return count_; }
  // The derivatives of the mean and of the variance by ln t.
  double slope(observations::Quantity quantity, double ln_t) const {
    return spline_.slope(mean_[observations::index_of(quantity)], ln_t);
  }
  double variance_slope(observations::Quantity quantity, double ln_t) const {
    return spline_.slope(scatter_.variance[observations::index_of(quantity)], ln_t);
  }

 private:
  LogSpline spline_;
  QuantityCurves mean_;
  RunScatter scatter_;
  std::size_t count_;
};

}  // namespace traceraft::likelihood
