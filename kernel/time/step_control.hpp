// Step sizes from error estimates.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/time/integrator.hpp"

namespace traceraft {

// Gomez–Hughes: Δt ← 0.9 √(tolerance/error) Δt, within bounds.
class StepControl {
 public:
  static constexpr double kSafety = 0.9;
  static constexpr double kMaxGrowth = 2.0;  // variable-step BDF2 is zero-stable below 1 + √2
  static constexpr double kMaxCut = 0.1;

  StepControl() = default;
  StepControl(const IntegratorSettings& settings, double span)
      : tolerance_(settings.tolerance),
        max_(settings.max_step > 0 ? settings.max_step : span),
        min_(std::min(max_, settings.min_step > 0 ? settings.min_step : 1e-14 * span)) {}

  double min_step() const { return min_; }
  double bounded(double dt) const { return std::clamp(dt, min_, max_); }

  double after_acceptance(double dt, double error) const {
    const double factor = error > 0 ? kSafety * std::sqrt(tolerance_ / error) : kMaxGrowth;
    return bounded(dt * std::clamp(factor, kMaxCut, kMaxGrowth));
  }
  // May return less than min_step(): then there is no step size.
  double after_rejection(double dt, double error) const {
    const double factor = kSafety * std::sqrt(tolerance_ / error);
    return dt * std::clamp(factor, kMaxCut, kSafety);
  }

 private:
  double tolerance_ = 1, max_ = 0, min_ = 0;
};

}  // namespace traceraft
