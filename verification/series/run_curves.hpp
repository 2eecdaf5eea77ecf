// What simulated vesicles do on average, as functions of time.
#pragma once

#include <array>
#include <vector>

#include "verification/vesicles/history.hpp"

namespace traceraft {

// Of the logarithms of each quantity over runs, on a grid of ln t.
class RunCurves {
 public:
  // At least two runs that have times > 0 in common. `sample`: which of them, with repetition.
  RunCurves(const std::vector<History>& runs, const std::vector<int>& sample);

  // Linear in ln t, constant beyond the ends.
  double mean(Quantity quantity, double ln_t) const {
    return grid_.at(mean_[static_cast<std::size_t>(quantity)], ln_t);
  }
  // Of one more run beside the mean of these.
  double variance(Quantity quantity, double ln_t) const {
    return grid_.at(variance_[static_cast<std::size_t>(quantity)], ln_t);
  }
  // Of the mean by ln t.
  double slope(Quantity quantity, double ln_t) const;

 private:
  LogTimes grid_;
  std::array<std::vector<double>, 3> mean_, variance_;
};

}  // namespace traceraft
