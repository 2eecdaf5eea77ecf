// Step sizes from error estimates.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/time/integrator.hpp"

namespace traceraft::time {

// Δt ← 0.9 (tolerance/error)^(1/power) Δt, within bounds, for an error that grows like Δt^power
// (power 2: Gomez–Hughes).
class StepControl {
 public:
  static constexpr double kSafety = 0.9;
  static constexpr double kMaxGrowth = 2.0;  // variable-step BDF2 is zero-stable below 1 + √2
  static constexpr double kMaxCut = 0.1;

  StepControl() = default;
  // `longest`: that the problem needs (DaeProblem::longest_step).
  StepControl(const IntegratorSettings& settings, double span, double power,
              double longest = std::numeric_limits<double>::infinity())
      : tolerance_(settings.tolerance),
        power_(power),
        max_(std::min(settings.max_step > 0 ? settings.max_step : span, longest)),
        min_(std::min(max_, settings.min_step > 0 ? settings.min_step : 1e-14 * span)) {}

  double min_step() const { return min_; }
  bool accepts(double error) const { return error <= tolerance_; }  // not if it is NaN
  double bounded(double dt) const { return std::clamp(dt, min_, max_); }

  double after_acceptance(double dt, double error) const {
    const double factor = error > 0 ? change(error) : kMaxGrowth;
    return bounded(dt * std::clamp(factor, kMaxCut, kMaxGrowth));
  }
  // May return less than min_step(): then there is no step size.
  double after_rejection(double dt, double error) const {
    return dt * std::clamp(change(error), kMaxCut, kSafety);
  }

 private:
  double change(double error) const { return kSafety * std::pow(tolerance_ / error, 1 / power_); }

  double tolerance_ = 1, power_ = 2, max_ = 0, min_ = 0;
};

// The first step of a run over `span`: as asked for, or such that a solution that moves with `rate`
// changes by `change`.
inline double first_step(const IntegratorSettings& settings, double span, double change,
                         double rate) {
  if (settings.initial_step > 0) return std::min(settings.initial_step, span);
  return rate > 0 ? std::min(change / rate, span) : span;
}

// One accepted step from t with the proposed size dt, cut until attempt(dt, error) succeeds with an
// error that is accepted. Calls accept(dt, new t, error); fatal if there is no step size.
template <class Attempt, class Accept>
Status take_step(const StepControl& control, double t, double t_end, double dt,
                 IntegratorStatistics& statistics, const Attempt& attempt, const Accept& accept) {
  if (!(t < t_end)) return Status::fatal("the end of the run has been reached");
  bool smallest = false;  // has the smallest step been tried?
  while (true) {
    const bool last = t + dt >= t_end * (1 - 1e-14);
    if (last) dt = t_end - t;
    double error = 0;
    const Status status = attempt(dt, error);
    if (status.outcome == Outcome::fatal) return status;
    if (status.ok() && control.accepts(error)) {
      accept(dt, last ? t_end : t + dt, error);
      return {};
    }
    // NaN and failed solves end up here, too.
    ++(status.ok() ? statistics.rejected : statistics.failures);
    if (smallest || !(dt > control.min_step()))
      return Status::fatal(
          "no step size: " + (status.ok() ? "the error stays above the tolerance" : status.why) +
          " down to the smallest step");
    const double smaller = status.ok() ? control.after_rejection(dt, error) : dt / 4;
    smallest = !(smaller >= control.min_step());
    dt = smallest ? control.min_step() : smaller;
  }
}

}  // namespace traceraft::time
