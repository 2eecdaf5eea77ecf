#include "drivers/output/time_left.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::output {
namespace {

// The most that ln t grows per settled step. The first steps grow faster, for as long as an
// integrator feels its way.
constexpr double kSettled = 0.1;
// While rafts coarsen the time a run has taken grows with a power of the time it has come to, in
// bursts: each raft that vanishes takes short steps. Measured in six runs of the paper's cases.
constexpr double kCostExponent = 0.28;
constexpr double kScatter = 2;  // of that law, and of the last steps

}  // namespace

void TimeLeft::note(double t, double seconds) {
  marks_.push_back({t, seconds});
  const double left = this->seconds();
  if (t >= end_)
    share_ = 1;
  else if (left > 0)
    share_ = std::max(share_, std::min(0.99, seconds / (seconds + left)));
}

TimeLeft::Range TimeLeft::range() const {
  const double by_steps = seconds();
  if (!(by_steps > 0)) return {};
  const Mark& now = marks_.back();
  const double by_law = now.seconds * (std::pow(end_ / now.t, kCostExponent) - 1);
  return {std::min(by_steps, by_law) / kScatter, std::max(by_steps, by_law) * kScatter};
}

double TimeLeft::seconds() const {
  if (marks_.size() < 2) return 0;
  const Mark& now = marks_.back();
  const std::size_t before = std::min(2 * marks_.size() / 3, marks_.size() - 2);
  const Mark& then = marks_[before];
  const double passed = now.seconds - then.seconds;
  if (!(now.t > then.t) || !(now.t < end_)) return 0;
  const double steady = (end_ - now.t) / (now.t - then.t);
  if (!(then.t > 0)) return passed * steady;
  const double grown = std::log(now.t / then.t);
  if (grown > kSettled * static_cast<double>(marks_.size() - 1 - before)) return 0;
  return passed * std::min(steady, std::log(end_ / now.t) / grown);
}

}  // namespace traceraft::output
