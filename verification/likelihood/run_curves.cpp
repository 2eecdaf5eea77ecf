#include "verification/likelihood/run_curves.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"

namespace traceraft::likelihood {
namespace {

constexpr double kMostCorrelated = 0.999;

std::vector<double> vector_of(const Vec& values) {
  return {values.data(), values.data() + values.size()};
}

// Runs lose rafts one by one, so that the mean of few of them has steps, and a likelihood has a
// minimum at each. Binomial weights of standard deviation 0.16 in ln t take these away and leave
// what is linear.
std::vector<double> smoothed(std::vector<double> values) {
  constexpr int kPasses = 4;  // each adds half a squared step to the variance
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<double> before = values;
    for (std::size_t i = 1; i + 1 < values.size(); ++i)
      values[i] = 0.25 * before[i - 1] + 0.5 * before[i] + 0.25 * before[i + 1];
  }
  return values;
}

}  // namespace

// The sample covariance of n runs is Σ d dᵀ/(n − 1), with d their deviations from the mean: it is
// that of Σ z d/√(n − 1), with independent normal z.
Vec weights_of_another_run(std::size_t runs, std::uint64_t seed, std::uint64_t stream,
                           std::uint64_t index) {
  Vec z(static_cast<Eigen::Index>(runs));
  for (Eigen::Index k = 0; k < z.size(); ++k)
    z[k] = normal_random(seed, stream, index * runs + static_cast<std::uint64_t>(k));
  const auto count = static_cast<double>(runs);
  return (1 / count + (z.array() - z.mean()) / std::sqrt(count - 1)).matrix();
}

Eigen::MatrixXd weights_of_other_runs(std::size_t runs, std::uint64_t seed, std::uint64_t stream) {
  const auto size = static_cast<Eigen::Index>(runs);
  Eigen::MatrixXd weights(size, size);
  for (Eigen::Index k = 0; k < size; ++k)
    weights.col(k) = weights_of_another_run(runs, seed, stream, static_cast<std::uint64_t>(k));
  return weights;
}

RunSamples::RunSamples(const std::vector<observations::History>& runs, std::vector<double> times)
    : times_(std::move(times)) {
  const auto rows = static_cast<Eigen::Index>(times_.size());
  const auto columns = static_cast<Eigen::Index>(runs.size());
  for (const observations::Quantity quantity : observations::kQuantities) {
    Eigen::MatrixXd& values = values_[observations::index_of(quantity)];
    values.resize(rows, columns);
    for (Eigen::Index j = 0; j < columns; ++j)
      for (Eigen::Index i = 0; i < rows; ++i)
        values(i, j) = observations::logarithm_of(
            quantity,
            runs[static_cast<std::size_t>(j)].at(quantity, times_[static_cast<std::size_t>(i)]));
  }
}

RunSamples RunSamples::others(const Eigen::MatrixXd& weights) const {
  RunSamples result = *this;
  for (Eigen::MatrixXd& values : result.values_) values = (values * weights).eval();
  return result;
}

QuantityCurves RunSamples::means() const {
  QuantityCurves result;
  for (std::size_t q = 0; q < result.size(); ++q)
    result[q] = smoothed(vector_of(values_[q].rowwise().mean()));
  return result;
}

RunScatter RunSamples::scatter() const {
  RunScatter result;
  const double step = times_.size() > 1 ? std::log(times_[1] / times_[0]) : 1;
  const auto rows = static_cast<Eigen::Index>(times_.size());
  const auto lag = std::min<Eigen::Index>(rows - 1, std::lround(1 / step));
  for (std::size_t q = 0; q < observations::kQuantities.size(); ++q) {
    const Eigen::MatrixXd off = values_[q].colwise() - values_[q].rowwise().mean().eval();
    const Vec squares = off.rowwise().squaredNorm();
    result.variance[q] = smoothed(vector_of(squares / static_cast<double>(off.cols() - 1)));
    const Eigen::Index pairs = rows - lag;
    const double product = off.topRows(pairs).cwiseProduct(off.bottomRows(pairs)).sum();
    const double norm = squares.head(pairs).cwiseProduct(squares.tail(pairs)).cwiseSqrt().sum();
    const double lagged = norm > 0 ? std::clamp(product / norm, 0.0, kMostCorrelated) : 0;
    result.correlation[q] = std::pow(lagged, 1 / (static_cast<double>(lag) * step));
  }
  return result;
}

LogSpline::LogSpline(const std::vector<double>& times) {
  if (times.size() < 2) throw InputError("the runs of an ensemble have no times in common");
  begin_ = std::log(times.front());
  step_ = std::log(times.back() / times.front()) / static_cast<double>(times.size() - 1);
}

LogSpline::Place LogSpline::place(const std::vector<double>& values, double ln_t) const {
  const auto last = static_cast<double>(values.size() - 1);
  const double x = std::clamp((ln_t - begin_) / step_, -0.5, last + 0.5);
  const auto k = std::min(static_cast<std::size_t>(x + 0.5), values.size() - 1);
  return {values[k == 0 ? 0 : k - 1], values[k], values[std::min(k + 1, values.size() - 1)],
          x - static_cast<double>(k)};
}

double LogSpline::at(const std::vector<double>& values, double ln_t) const {
  const Place p = place(values, ln_t);
  const double before = 0.5 - p.offset, after = 0.5 + p.offset;
  return 0.5 * before * before * p.before + (0.75 - p.offset * p.offset) * p.here +
         0.5 * after * after * p.after;
}

double LogSpline::slope(const std::vector<double>& values, double ln_t) const {
  const Place p = place(values, ln_t);
  return ((0.5 + p.offset) * (p.after - p.here) + (0.5 - p.offset) * (p.here - p.before)) / step_;
}

RunCurves::RunCurves(const std::vector<observations::History>& runs)
    : RunCurves(RunSamples(runs, observations::common_times(runs, observations::kCurveTimes))) {}

RunCurves::RunCurves(const RunSamples& samples)
    : RunCurves(samples.times(), samples.means(), samples.scatter(), samples.count()) {}

RunCurves::RunCurves(const std::vector<double>& times, QuantityCurves mean, RunScatter scatter,
                     std::size_t count)
    : spline_(times), mean_(std::move(mean)), scatter_(std::move(scatter)), count_(count) {
  const double of_mean = 1 + 1 / static_cast<double>(count);
  for (std::vector<double>& values : scatter_.variance)
    for (double& value : values) value *= of_mean;
}

RunCurves RunCurves::combined(const std::vector<const RunCurves*>& all, const Vec& means,
                              const Vec& variances) {
  RunCurves result = *all.front();
  for (std::size_t q = 0; q < observations::kQuantities.size(); ++q) {
    std::vector<double>&mean = result.mean_[q], &variance = result.scatter_.variance[q];
    std::fill(mean.begin(), mean.end(), 0);
    std::fill(variance.begin(), variance.end(), 0);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto index = static_cast<Eigen::Index>(k);
      for (std::size_t i = 0; i < mean.size(); ++i) {
        mean[i] += means[index] * all[k]->mean_[q][i];
        variance[i] += variances[index] * all[k]->scatter_.variance[q][i];
      }
    }
  }
  return result;
}

double RunCurves::correlation(observations::Quantity quantity, double ln_factor) const {
  return std::pow(scatter_.correlation[observations::index_of(quantity)], std::fabs(ln_factor));
}

Eigen::MatrixXd RunCurves::covariance(observations::Quantity quantity, const Vec& ln_t) const {
  const Eigen::Index count = ln_t.size();
  Eigen::MatrixXd result(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      result(i, j) = result(j, i) =
          std::sqrt(variance(quantity, ln_t[i]) * variance(quantity, ln_t[j])) *
          correlation(quantity, ln_t[i] - ln_t[j]);
  return result;
}

}  // namespace traceraft::likelihood
