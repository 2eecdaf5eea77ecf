#include "verification/selection/series/series_size.hpp"

#include <cmath>

namespace traceraft::selection {
namespace {

double mean_logarithm(const std::vector<observations::History>& runs,
                      observations::Quantity quantity, double t) {
  double sum = 0;
  for (const observations::History& run : runs)
    sum += observations::logarithm_of(quantity, run.at(quantity, t));
  return sum / static_cast<double>(runs.size());
}

}  // namespace

double series_change(const std::vector<observations::History>& base,
                     const std::vector<observations::History>& changed,
                     const statistics::Window& looks) {
  constexpr int kTimes = 5;
  double squares = 0;
  for (int k = 0; k < kTimes; ++k) {
    const double t = looks.begin * std::pow(looks.end / looks.begin, k / (kTimes - 1.0));
    for (const observations::Quantity quantity : observations::kQuantities)
      squares +=
          std::pow(mean_logarithm(changed, quantity, t) - mean_logarithm(base, quantity, t), 2);
  }
  return std::sqrt(squares / (kTimes * static_cast<double>(observations::kQuantities.size())));
}

}  // namespace traceraft::selection
