#include "verification/vesicles/likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "backends/nlopt/minimise.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

constexpr int kPerDecade = 20;
constexpr double kLeastCount = 0.5;             // of rafts: there may be none for a moment
constexpr double kRoundingVariance = 1 / 12.0;  // of a whole number
constexpr double kFirstStep = 0.4;              // of ln R²/D
constexpr double kLeastScatter = 0.01, kUsualScatter = 0.1, kLargestScatter = 1;

double square(double x) {
  return x * x;
}

struct MeanAndVariance {
  double mean, variance;
};

MeanAndVariance of_logarithms(const std::vector<History>& runs, const std::vector<int>& sample,
                              Quantity quantity, double t) {
  std::vector<double> logarithms;
  for (const int k : sample)
    logarithms.push_back(std::log(std::max(runs[k].at(quantity, t), kLeastCount)));
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

// −2 ln of the likelihood.
double deviance_of(const MeasuredVesicles& data,
                   const std::vector<std::pair<std::size_t, std::size_t>>& vesicles,
                   const std::vector<int>& sample, const RunStatistics& runs,
                   double seconds_per_unit, double scatter) {
  double sum = 0;
  const auto add = [&](double y, double sigma2, const RunStatistics::Normal& expected) {
    const double variance = expected.variance + sigma2;
    sum += (y - expected.mean) * (y - expected.mean) / variance + std::log(variance);
  };
  for (const int k : sample)
    for (std::size_t i = vesicles[k].first; i < vesicles[k].second; ++i) {
      const Measurement& m = data.measurements[i];
      const double t = std::max(m.time, 1e-12) / seconds_per_unit;
      if (const auto& p = m.of(Quantity::perimeter); p && *p > 0)
        add(std::log(*p), scatter * scatter + square(m.sigma_of(Quantity::perimeter) / *p),
            runs.at(Quantity::perimeter, t));
      if (const auto& n = m.of(Quantity::rafts); n && *n > 0) {
        // By the number that is expected: by the one that was counted, small ones would count less.
        const RunStatistics::Normal expected = runs.at(Quantity::rafts, t);
        const double error2 = std::max(kRoundingVariance, square(m.sigma_of(Quantity::rafts)));
        add(std::log(*n), error2 * std::exp(-2 * expected.mean), expected);
      }
    }
  return sum;
}

}  // namespace

double ScatterLaw::variance(double rafts) const {
  return a + b * independent_share(rafts);
}

ScatterLaws scatter_laws(const std::vector<std::vector<History>>& ensembles) {
  Points perimeter, rafts;
  for (const std::vector<History>& runs : ensembles) {
    const std::vector<int> all = each_once(runs.size());
    for (const double t : common_times(runs, kPerDecade)) {
      const MeanAndVariance count = of_logarithms(runs, all, Quantity::rafts, t);
      const double x = independent_share(std::exp(count.mean));
      rafts.emplace_back(x, count.variance);
      perimeter.emplace_back(x, of_logarithms(runs, all, Quantity::perimeter, t).variance);
    }
  }
  return {fitted_scatter(perimeter), fitted_scatter(rafts)};
}

RunStatistics::RunStatistics(const std::vector<History>& runs, const std::vector<int>& sample,
                             const ScatterLaws& scatter)
    : RunStatistics(runs, sample, scatter, common_times(runs, kPerDecade)) {}

RunStatistics::RunStatistics(const std::vector<History>& runs, const std::vector<int>& sample,
                             const ScatterLaws& scatter, const std::vector<double>& times)
    : grid_(times) {
  const double more = 1 + 1 / static_cast<double>(sample.size());
  for (const double t : times) {
    const double rafts = of_logarithms(runs, sample, Quantity::rafts, t).mean;
    const double count = std::exp(rafts);
    rafts_.mean.push_back(rafts);
    rafts_.variance.push_back(more * scatter.rafts.variance(count));
    perimeter_.mean.push_back(of_logarithms(runs, sample, Quantity::perimeter, t).mean);
    perimeter_.variance.push_back(more * scatter.perimeter.variance(count));
  }
}

RunStatistics::Normal RunStatistics::at(Quantity quantity, double t) const {
  const Curve& curve = quantity == Quantity::perimeter ? perimeter_ : rafts_;
  const double ln_t = std::log(t);
  return {grid_.at(curve.mean, ln_t), grid_.at(curve.variance, ln_t)};
}

TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, const TimeUnit& unit) {
  const double low = std::log(unit.allowed.low), high = std::log(unit.allowed.high),
               start = std::log(unit.start);
  TimeFit best{unit.start, kUsualScatter, HUGE_VAL};
  // Several starts: where a plateau is reached, time makes no difference.
  for (const double first : {0.5 * (low + start), start, 0.5 * (start + high)}) {
    const TimeFit found =
        fit_time(data, sample, runs, unit, {std::exp(first), kUsualScatter, HUGE_VAL});
    if (found.deviance < best.deviance) best = found;
  }
  return best;
}

TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, const TimeUnit& unit, const TimeFit& near) {
  const auto vesicles = data.vesicles();
  const auto deviance = [&](const std::vector<double>& x) {
    return deviance_of(data, vesicles, sample, runs, std::exp(x[0]), std::exp(x[1]));
  };
  const Minimum found = minimise({deviance,
                                  {std::log(near.seconds_per_unit), std::log(near.scatter)},
                                  {std::log(unit.allowed.low), std::log(kLeastScatter)},
                                  {std::log(unit.allowed.high), std::log(kLargestScatter)},
                                  {kFirstStep, 0.5},
                                  1e-4,
                                  400});
  return {std::exp(found.x[0]), std::exp(found.x[1]), found.value};
}

}  // namespace traceraft
