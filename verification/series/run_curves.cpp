#include "verification/series/run_curves.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/core/error.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

constexpr int kPerDecade = 20;
constexpr double kLeastCount = 0.5, kLeastValue = 1e-6;

}  // namespace

RunCurves::RunCurves(const std::vector<History>& runs, const std::vector<int>& sample) {
  const std::vector<double> times = common_times(runs, kPerDecade);
  if (times.size() < 2) throw InputError("the runs of an ensemble have no times in common");
  begin_ = std::log(times.front());
  step_ = std::log(times.back() / times.front()) / static_cast<double>(times.size() - 1);
  for (const Quantity quantity : kQuantities)
    for (const double t : times) {
      std::vector<double> logarithms;
      for (const int k : sample)
        logarithms.push_back(logarithm_of(quantity, runs[k].at(quantity, t)));
      const Moments m = moments(logarithms);
      mean_[static_cast<std::size_t>(quantity)].push_back(m.mean);
      variance_[static_cast<std::size_t>(quantity)].push_back(m.deviation * m.deviation);
    }
}

double RunCurves::slope(Quantity quantity, double ln_t) const {
  return (mean(quantity, ln_t + step_) - mean(quantity, ln_t - step_)) / (2 * step_);
}

double RunCurves::at(const Curves& curves, Quantity quantity, double ln_t) const {
  const std::vector<double>& values = curves[static_cast<std::size_t>(quantity)];
  const double place =
      std::clamp((ln_t - begin_) / step_, 0.0, static_cast<double>(values.size() - 1));
  const auto below = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const double share = place - static_cast<double>(below);
  return (1 - share) * values[below] + share * values[below + 1];
}

std::vector<int> each_once(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

double logarithm_of(Quantity quantity, double value) {
  return std::log(std::max(value, quantity == Quantity::rafts ? kLeastCount : kLeastValue));
}

}  // namespace traceraft
