#include "verification/vesicles/likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "backends/nlopt/minimise.hpp"
#include "verification/measure/fit.hpp"
#include "verification/measure/log_of_product.hpp"
#include "verification/vesicles/stated_errors.hpp"

namespace traceraft {
namespace {

constexpr double kUsualScatter = 0.1, kLargestScatter = 1;

double square(double x) {
  return x * x;
}

struct MeanAndVariance {
  double mean, variance;
};

MeanAndVariance of_logarithms(const std::vector<History>& runs, Quantity quantity, double t) {
  std::vector<double> logarithms;
  for (const History& run : runs) logarithms.push_back(logarithm_of(quantity, run.at(quantity, t)));
  const Moments m = moments(logarithms);
  return {m.mean, m.deviation * m.deviation};
}

double independent_share(double rafts) {
  const double n = std::max(rafts, 1.0);
  return (n - 1) / (n * n);
}

// Least squares of variance = a + b x, with a, b ≥ 0.
ScatterLaw fitted_scatter(const Points& points) {
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, spread = 0;
  for (const auto& [x, y] : points) {
    mean_x += x / static_cast<double>(points.size());
    mean_y += y / static_cast<double>(points.size());
    xx += x * x;
    xy += x * y;
  }
  for (const auto& point : points) spread = std::max(spread, std::fabs(point.first - mean_x));
  if (!(spread > 1e-9)) return {mean_y, 0};  // one number of rafts everywhere
  const Line line = fit_line(points);
  if (line.slope < 0) return {mean_y, 0};
  if (line.intercept < 0) return {0, xy / xx};
  return {line.intercept, line.slope};
}

// A measured logarithm.
struct Logarithm {
  double value;
  StatedError error;
};

// At one time of one vesicle.
struct Look {
  double ln_time;
  std::optional<Logarithm> perimeter, rafts;
};

std::vector<Look> looks_of(const MeasuredVesicles& data, const std::vector<int>& sample) {
  const auto vesicles = data.vesicles();
  const StatedErrors errors(data);
  std::vector<Look> looks;
  for (const int k : sample)
    for (std::size_t i = vesicles[k].first; i < vesicles[k].second; ++i) {
      const Measurement& m = data.measurements[i];
      if (!(m.time > 0)) continue;  // what runs begin with is none of their doing
      Look look{std::log(m.time), {}, {}};
      if (const auto& p = m.of(Quantity::perimeter); p && *p > 0)
        look.perimeter = {std::log(*p), errors.of(m, Quantity::perimeter)};
      if (const auto& n = m.of(Quantity::rafts); n && *n > 0)
        look.rafts = {std::log(*n), errors.of(m, Quantity::rafts)};
      if (look.perimeter || look.rafts) looks.push_back(look);
    }
  return looks;
}

// Σ of −2 ln of normal densities.
class Deviance {
 public:
  void add(const Logarithm& measured, double mean, double scatter2) {
    const double variance = scatter2 + measured.error.of_logarithm(mean);
    squares_ += square(measured.value - mean - measured.error.bias(mean)) / variance;
    variances_.multiply(variance);
  }
  double value() const { return squares_ + variances_.value(); }

 private:
  double squares_ = 0;
  LogOfProduct variances_;
};

// −2 ln of the likelihood.
double deviance_of(const std::vector<Look>& looks, const RunStatistics& runs,
                   double seconds_per_unit, double scatter) {
  const double ln_unit = std::log(seconds_per_unit), scatter2 = scatter * scatter;
  Deviance deviance;
  for (const Look& look : looks) {
    const RunStatistics::AtTime expected = runs.at(look.ln_time - ln_unit);
    if (look.perimeter)
      deviance.add(*look.perimeter, expected.ln_perimeter, expected.perimeter_variance + scatter2);
    if (look.rafts) deviance.add(*look.rafts, expected.ln_rafts, expected.rafts_variance);
  }
  return deviance.value();
}

struct Steps {
  double unit, scatter;  // the first ones, of the logarithms
};

TimeFit fit_looks(const std::vector<Look>& looks, const RunStatistics& runs, const TimeUnit& unit,
                  const TimeFit& near, const Steps& steps) {
  const auto deviance = [&](const std::vector<double>& x) {
    return deviance_of(looks, runs, std::exp(x[0]), std::exp(x[1]));
  };
  const Minimum found = minimise({deviance,
                                  {std::log(near.seconds_per_unit), std::log(near.scatter)},
                                  {std::log(unit.allowed.low), std::log(kLeastScatter)},
                                  {std::log(unit.allowed.high), std::log(kLargestScatter)},
                                  {steps.unit, steps.scatter},
                                  1e-4,
                                  400});
  return {std::exp(found.x[0]), std::exp(found.x[1]), found.value};
}

}  // namespace

double ScatterLaw::variance(double rafts) const {
  return a + b * independent_share(rafts);
}

ScatterLaws scatter_laws(const std::vector<std::vector<History>>& ensembles) {
  Points perimeter, rafts;
  for (const std::vector<History>& runs : ensembles) {
    for (const double t : common_times(runs, kCurveTimes)) {
      const MeanAndVariance count = of_logarithms(runs, Quantity::rafts, t);
      const double x = independent_share(std::exp(count.mean));
      rafts.emplace_back(x, count.variance);
      perimeter.emplace_back(x, of_logarithms(runs, Quantity::perimeter, t).variance);
    }
  }
  return {fitted_scatter(perimeter), fitted_scatter(rafts)};
}

SampledRuns::SampledRuns(const std::vector<History>& runs, std::vector<double> at)
    : times(std::move(at)) {
  const auto rows = static_cast<Eigen::Index>(times.size());
  const auto columns = static_cast<Eigen::Index>(runs.size());
  for (Eigen::MatrixXd* curves : {&perimeter, &rafts, &fraction}) curves->resize(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) {
      const History& run = runs[static_cast<std::size_t>(j)];
      const double t = times[static_cast<std::size_t>(i)];
      perimeter(i, j) = logarithm_of(Quantity::perimeter, run.at(Quantity::perimeter, t));
      rafts(i, j) = logarithm_of(Quantity::rafts, run.at(Quantity::rafts, t));
      fraction(i, j) = run.at(Quantity::fraction, t);
    }
}

RunStatistics::RunStatistics(const SampledRuns& runs, const std::vector<int>& sample,
                             const ScatterLaws& scatter)
    : grid_(runs.times), scatter_(scatter), of_mean_(1 + 1 / static_cast<double>(sample.size())) {
  const auto mean = [&](const Eigen::MatrixXd& curves) {
    const Vec values = curves(Eigen::all, sample).rowwise().mean();
    return std::vector<double>(values.data(), values.data() + values.size());
  };
  mean_ = {mean(runs.perimeter), mean(runs.rafts), mean(runs.fraction)};
}

RunStatistics RunStatistics::combined(const std::vector<RunStatistics>& all,
                                      const std::vector<double>& weights) {
  RunStatistics result = all.front();
  const auto combine = [&](std::vector<double> Means::*curve) {
    std::vector<double>& values = result.mean_.*curve;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = 0;
      for (std::size_t k = 0; k < all.size(); ++k)
        values[i] += weights[k] * (all[k].mean_.*curve)[i];
    }
  };
  combine(&Means::perimeter);
  combine(&Means::rafts);
  combine(&Means::fraction);
  return result;
}

RunStatistics::AtTime RunStatistics::at(double ln_t) const {
  const double ln_rafts = grid_.at(mean_.rafts, ln_t), rafts = std::exp(ln_rafts);
  return {grid_.at(mean_.perimeter, ln_t), of_mean_ * scatter_.perimeter.variance(rafts), ln_rafts,
          of_mean_ * scatter_.rafts.variance(rafts)};
}

double RunStatistics::fraction(double t) const {
  return grid_.at(mean_.fraction, std::log(t));
}

TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, const TimeUnit& unit) {
  const double low = std::log(unit.allowed.low), high = std::log(unit.allowed.high),
               start = std::log(unit.start);
  const std::vector<Look> looks = looks_of(data, sample);
  TimeFit best{unit.start, kUsualScatter, HUGE_VAL};
  // Several starts: where a plateau is reached, time makes no difference.
  for (const double first : {0.5 * (low + start), start, 0.5 * (start + high)}) {
    const TimeFit found =
        fit_looks(looks, runs, unit, {std::exp(first), kUsualScatter, HUGE_VAL}, {0.4, 0.5});
    if (found.deviance < best.deviance) best = found;
  }
  return best;
}

Interval as_probable(const MeasuredVesicles& data, const std::vector<int>& sample,
                     const RunStatistics& runs, const TimeUnit& unit, const TimeFit& fit) {
  constexpr int kUnits = 200;
  const std::vector<Look> looks = looks_of(data, sample);
  const double low = std::log(unit.allowed.low), high = std::log(unit.allowed.high);
  const double most =
      deviance_of(looks, runs, fit.seconds_per_unit, fit.scatter) + kAboutAsProbable;
  Interval range{fit.seconds_per_unit, fit.seconds_per_unit};
  for (int k = 0; k <= kUnits; ++k) {
    const double seconds = std::exp(low + (high - low) * k / kUnits);
    if (deviance_of(looks, runs, seconds, fit.scatter) > most) continue;
    range.low = std::min(range.low, seconds);
    range.high = std::max(range.high, seconds);
  }
  return range;
}

TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, const TimeUnit& unit, const TimeFit& near) {
  return fit_looks(looks_of(data, sample), runs, unit, near, {0.1, 0.1});
}

}  // namespace traceraft
