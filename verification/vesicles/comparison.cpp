#include "verification/vesicles/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

bool relative(Quantity quantity) {
  return quantity != Quantity::fraction;
}

// Of a count or a perimeter whose logarithm is taken: there may be no raft.
constexpr double kLeast = 0.5;
// Rounding to whole rafts alone has this deviation.
const double kRoundingDeviation = 1 / std::sqrt(12.0);

Agreement agreement(const MeasuredVesicles& data, const std::vector<History>& runs,
                    Quantity quantity) {
  Agreement result{quantity};
  double first = 0, last = HUGE_VAL;
  for (const History& run : runs) {
    first = std::max(first, run.time.front());
    last = std::min(last, run.time.back());
  }
  for (const Measurement& m : data.measurements) {
    if (!m.of(quantity)) continue;
    if (m.time < first || m.time > last) {
      ++result.beyond;
      continue;
    }
    const double y = *m.of(quantity);
    std::vector<double> values;
    for (const History& run : runs) values.push_back(run.at(quantity, m.time));
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    result.within += y >= *low && y <= *high;
    ++result.measurements;
    double sigma =
        std::max(m.sigma_of(quantity), quantity == Quantity::rafts ? kRoundingDeviation : 0.0);
    double measured = y;
    if (relative(quantity)) {
      const double above_zero = std::max(y, kLeast);
      sigma /= above_zero;
      measured = std::log(above_zero);
      for (double& value : values) value = std::log(std::max(value, kLeast));
    }
    const Moments runs_here = moments(values);
    const double of_mean = 1 + 1 / static_cast<double>(runs.size());
    const double deviation = std::hypot(runs_here.deviation * std::sqrt(of_mean), sigma);
    const double z = (measured - runs_here.mean) / std::max(deviation, 1e-6);
    const double unit = relative(quantity) ? 1 : std::max(runs_here.mean, 1e-6);
    result.scatter += deviation * deviation / (unit * unit);
    result.bias += z;
    result.misfit += z * z;
  }
  const double count = std::max(1, result.measurements);
  result.bias /= count;
  result.misfit = std::sqrt(result.misfit / count);
  result.scatter = std::sqrt(result.scatter / count);
  return result;
}

}  // namespace

std::vector<Agreement> compare_with_runs(const MeasuredVesicles& data,
                                         const std::vector<History>& runs) {
  if (runs.size() < 2)
    throw InputError("a comparison with measurements needs two finished runs at least");
  std::vector<Agreement> all;
  for (const Quantity quantity : kQuantities) all.push_back(agreement(data, runs, quantity));
  return all;
}

SameKind same_kind(std::size_t runs) {
  const auto n = static_cast<double>(runs);
  return {(n - 1) / (n + 1), n > 3 ? std::sqrt((n - 1) / (n - 3)) : HUGE_VAL};
}

}  // namespace traceraft
