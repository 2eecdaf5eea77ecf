#include "drivers/explain/search_time_left.hpp"

#include <algorithm>

namespace traceraft::explain {
namespace {

// In units of the first calibration; measured at 24 cells with one hidden effect: refits 1.1,
// calibration with the effect 0.8, the check on another mesh 1.3.
constexpr output::TimeLeft::Range kFromRefit{0.7, 4}, kFromCalibration{1, 3}, kFromConfirm{0.6, 2};
// Each further effect that the search may find.
constexpr double kFurtherEffect = 2.5;

}  // namespace

output::TimeLeft::Range SearchTimeLeft::note(const selection::SearchState& state, double seconds) {
  if (calibration_ == 0 && last_ == selection::SearchStep::calibrate &&
      state.next == selection::SearchStep::screen)
    calibration_ = seconds - before_;
  before_ = seconds;
  last_ = state.next;
  const auto found = static_cast<int>(state.so_far.found.hypothesis.added());
  const auto range = [&](const output::TimeLeft::Range& share,
                         int more) -> output::TimeLeft::Range {
    return {calibration_ * share.low,
            calibration_ * (share.high + kFurtherEffect * std::max(0, more))};
  };
  switch (state.next) {
    case selection::SearchStep::refit:
      return range(kFromRefit, most_effects_ - found - 1);
    case selection::SearchStep::calibrate:
      return range(kFromCalibration, most_effects_ - found);
    case selection::SearchStep::confirm:
      return range(kFromConfirm, 0);
    default:
      return {};
  }
}

}  // namespace traceraft::explain
