#include "verification/series/run_curves.hpp"

#include <algorithm>
#include <cmath>

#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

constexpr int kPerDecade = 20;
constexpr double kLeastCount = 0.5, kLeastValue = 1e-6;

}  // namespace

RunCurves::RunCurves(const std::vector<History>& runs, const std::vector<int>& sample)
    : grid_(common_times(runs, kPerDecade)) {
  for (const Quantity quantity : kQuantities)
    for (const double t : common_times(runs, kPerDecade)) {
      std::vector<double> logarithms;
      for (const int k : sample)
        logarithms.push_back(logarithm_of(quantity, runs[k].at(quantity, t)));
      const Moments m = moments(logarithms);
      mean_[static_cast<std::size_t>(quantity)].push_back(m.mean);
      variance_[static_cast<std::size_t>(quantity)].push_back(m.deviation * m.deviation);
    }
}

double RunCurves::slope(Quantity quantity, double ln_t) const {
  const double step = grid_.step();
  return (mean(quantity, ln_t + step) - mean(quantity, ln_t - step)) / (2 * step);
}

double logarithm_of(Quantity quantity, double value) {
  return std::log(std::max(value, quantity == Quantity::rafts ? kLeastCount : kLeastValue));
}

}  // namespace traceraft
