#include "verification/vesicles/likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "backends/nlopt/minimise.hpp"

namespace traceraft {
namespace {

constexpr int kPerDecade = 20;
const double kSmoothing = std::log(2.0);
constexpr double kLeastCount = 0.5;             // of rafts: there may be none for a moment
constexpr double kRoundingVariance = 1 / 12.0;  // of a whole number
constexpr double kLeastScatter = 0.01, kLargestScatter = 1;

RunStatistics::Normal normal_of(const std::vector<History>& runs, const std::vector<int>& sample,
                                Quantity quantity, double t) {
  double sum = 0, squares = 0;
  const double count = static_cast<double>(sample.size());
  for (const int k : sample) {
    const double y = std::log(std::max(runs[k].at(quantity, t), kLeastCount));
    sum += y;
    squares += y * y;
  }
  const double mean = sum / count;
  // The mean of a few runs is itself uncertain.
  const double variance = std::max(0.0, (squares - count * mean * mean) / std::max(1.0, count - 1));
  return {mean, variance * (1 + 1 / count)};
}

void smooth_variances(std::vector<RunStatistics::Normal>& values, double step) {
  const int reach = static_cast<int>(kSmoothing / step);
  const std::vector<RunStatistics::Normal> rough = values;
  const int count = static_cast<int>(values.size());
  for (int i = 0; i < count; ++i) {
    double sum = 0;
    int terms = 0;
    for (int k = std::max(0, i - reach); k <= std::min(count - 1, i + reach); ++k, ++terms)
      sum += rough[k].variance;
    values[i].variance = sum / terms;
  }
}

}  // namespace

RunStatistics::RunStatistics(const std::vector<History>& runs, const std::vector<int>& sample) {
  const std::vector<double> times = common_times(runs, kPerDecade);
  begin_ = std::log(times.front());
  step_ = std::log(times.back() / times.front()) / static_cast<double>(times.size() - 1);
  for (const double t : times) {
    perimeter_.push_back(normal_of(runs, sample, Quantity::perimeter, t));
    rafts_.push_back(normal_of(runs, sample, Quantity::rafts, t));
  }
  smooth_variances(perimeter_, step_);
  smooth_variances(rafts_, step_);
}

RunStatistics::Normal RunStatistics::at(Quantity quantity, double t) const {
  const std::vector<Normal>& values = quantity == Quantity::perimeter ? perimeter_ : rafts_;
  const double place =
      std::clamp((std::log(t) - begin_) / step_, 0.0, static_cast<double>(values.size() - 1));
  const auto below = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const double share = place - static_cast<double>(below);
  const Normal &a = values[below], &b = values[below + 1];
  return {a.mean + share * (b.mean - a.mean), a.variance + share * (b.variance - a.variance)};
}

double RunStatistics::last_time() const {
  return std::exp(begin_ + step_ * static_cast<double>(perimeter_.size() - 1));
}

TimeFit fit_time(const MeasuredVesicles& data, const std::vector<int>& sample,
                 const RunStatistics& runs, double start, double range) {
  const auto vesicles = data.vesicles();
  const auto deviance = [&](double seconds_per_unit, double scatter) {
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
          add(std::log(*p), scatter * scatter, runs.at(Quantity::perimeter, t));
        // At a given fraction the number goes with the square of the perimeter.
        if (const auto& n = m.of(Quantity::rafts); n && *n > 0)
          add(std::log(*n), 4 * scatter * scatter + kRoundingVariance / (*n * *n),
              runs.at(Quantity::rafts, t));
      }
    return sum;
  };
  const double width = std::log(range);
  TimeFit best{start, 0.1, HUGE_VAL};
  // Several starts: where a plateau is reached, time makes no difference.
  for (const double first : {-0.5 * width, 0.0, 0.5 * width}) {
    const Minimum found = minimise({[&](const std::vector<double>& x) {
                                      return deviance(start * std::exp(x[0]), std::exp(x[1]));
                                    },
                                    {first, std::log(0.1)},
                                    {-width, std::log(kLeastScatter)},
                                    {width, std::log(kLargestScatter)},
                                    {0.2 * width, 0.5},
                                    1e-4,
                                    400});
    if (found.value < best.deviance)
      best = {start * std::exp(found.x[0]), std::exp(found.x[1]), found.value};
  }
  return best;
}

}  // namespace traceraft
