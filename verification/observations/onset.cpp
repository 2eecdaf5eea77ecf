#include "verification/observations/onset.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::observations {
namespace {

constexpr int kDelays = 40;
constexpr double kLongest = 0.95;  // over the time of the first look

MeasuredVesicles shifted(MeasuredVesicles data, double delay) {
  for (Measurement& m : data.measurements) m.time -= delay;
  return data;
}

bool any_trend(const std::vector<Agreement>& agreements) {
  return std::any_of(agreements.begin(), agreements.end(),
                     [](const Agreement& a) { return a.has_trend(); });
}

// In squares of standard errors.
double trends(const std::vector<Agreement>& agreements) {
  double sum = 0;
  for (const Agreement& a : agreements)
    if (a.quantity != Quantity::fraction) sum += std::pow(a.trend_deviations(), 2);
  return sum;
}

}  // namespace

std::optional<Onset> onset_without_trend(const MeasuredVesicles& data,
                                         const std::vector<History>& runs) {
  std::vector<Agreement> before = compare_with_runs(data, runs);
  if (!any_trend(before)) return {};
  const double longest = kLongest * looks(data).begin;
  Onset best{0, false, std::move(before)};
  for (int k = 1; k <= kDelays; ++k) {
    const double delay = longest * k / kDelays;
    std::vector<Agreement> here = compare_with_runs(shifted(data, delay), runs);
    if (trends(here) < trends(best.agreements)) best = {delay, k == kDelays, std::move(here)};
  }
  return any_trend(best.agreements) ? std::nullopt : std::optional(std::move(best));
}

}  // namespace traceraft::observations
