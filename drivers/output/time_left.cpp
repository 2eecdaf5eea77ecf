#include "drivers/output/time_left.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft {

void TimeLeft::note(double t, double seconds) {
  marks_.push_back({t, seconds});
  const double left = this->seconds();
  if (t >= end_)
    share_ = 1;
  else if (left > 0)
    share_ = std::max(share_, std::min(0.99, seconds / (seconds + left)));
}

double TimeLeft::seconds() const {
  if (marks_.size() < 2) return 0;
  const Mark& now = marks_.back();
  const Mark& then = marks_[std::min(2 * marks_.size() / 3, marks_.size() - 2)];
  const double passed = now.seconds - then.seconds;
  if (!(now.t > then.t) || !(now.t < end_)) return 0;
  const double steady = (end_ - now.t) / (now.t - then.t);
  const double growing = then.t > 0 ? std::log(end_ / now.t) / std::log(now.t / then.t) : steady;
  return passed * std::min(steady, growing);
}

}  // namespace traceraft
