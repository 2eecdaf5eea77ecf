#include "verification/series/run_curves.hpp"

#include "verification/measure/fit.hpp"

namespace traceraft {

RunCurves::RunCurves(const std::vector<History>& runs, const std::vector<int>& sample)
    : grid_(common_times(runs, kCurveTimes)) {
  const std::vector<double> times = common_times(runs, kCurveTimes);
  const double of_mean = 1 + 1 / static_cast<double>(sample.size());
  for (const Quantity quantity : kQuantities)
    for (const double t : times) {
      std::vector<double> logarithms;
      for (const int k : sample)
        logarithms.push_back(logarithm_of(quantity, runs[k].at(quantity, t)));
      const Moments m = moments(logarithms);
      mean_[static_cast<std::size_t>(quantity)].push_back(m.mean);
      variance_[static_cast<std::size_t>(quantity)].push_back(of_mean * m.deviation * m.deviation);
    }
}

double RunCurves::slope(Quantity quantity, double ln_t) const {
  const double step = grid_.step();
  return (mean(quantity, ln_t + step) - mean(quantity, ln_t - step)) / (2 * step);
}

}  // namespace traceraft
