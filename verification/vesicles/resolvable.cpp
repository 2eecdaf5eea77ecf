#include "verification/vesicles/resolvable.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/text.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {
namespace {

constexpr double kDiffraction = 0.2;  // µm

// Of the rafts of a look if they are equal discs, by their boundaries (or of what is between them,
// of which a strip would be half as wide) or by their number; infinite where nothing tells.
double diameter_of(const Measurement& m) {
  const double fraction = m.of(Quantity::fraction).value_or(0.5);
  double diameter = HUGE_VAL;
  if (const double perimeter = m.of(Quantity::perimeter).value_or(0); perimeter > 0)
    diameter = 16 * kPi * std::min(fraction, 1 - fraction) / perimeter;
  if (const double rafts = m.of(Quantity::rafts).value_or(0); rafts > 0)
    diameter = std::min(diameter, 4 * std::sqrt(fraction / rafts));
  return diameter * m.radius;
}

// Of the perimeter, over the shortest that a raft fraction can have, that of a cap; infinite where
// nothing tells. As far as errors of measuring allow.
double length_of(const Measurement& m) {
  const auto perimeter = m.of(Quantity::perimeter), fraction = m.of(Quantity::fraction);
  if (!perimeter || !fraction) return HUGE_VAL;
  constexpr double kSure = 2;
  const double least = std::min(*fraction, 1 - *fraction) - kSure * m.sigma_of(Quantity::fraction);
  if (!(least > 0)) return HUGE_VAL;
  return (*perimeter + kSure * m.sigma_of(Quantity::perimeter)) /
         (4 * kPi * std::sqrt(least * (1 - least)));
}

// Looks of which a measure is below what is possible, and the one of which it is least.
struct Impossible {
  std::ptrdiff_t count = 0;
  const Measurement* worst = nullptr;
  double least = 0;
};
Impossible below(const MeasuredVesicles& data, double (*measure)(const Measurement&),
                 double possible) {
  Impossible found;
  found.least = possible;
  for (const Measurement& m : data.measurements) {
    const double value = measure(m);
    if (!(value < possible)) continue;
    ++found.count;
    if (value < found.least) {
      found.worst = &m;
      found.least = value;
    }
  }
  return found;
}

}  // namespace

std::string unusual_times(const MeasuredVesicles& data) {
  constexpr double kDay = 86400, kSecond = 1;
  const double last = looks(data).end;
  if (last >= kSecond && last <= kDay) return "";
  return formatted("The last look is %.3g s after time zero. Is time_unit right?", last);
}

std::string too_long_boundaries(const MeasuredVesicles& data) {
  const Impossible narrow = below(data, diameter_of, kDiffraction);
  if (narrow.count == 0) return "";
  return formatted(
      "Of %td of %zu looks the perimeter is so long, or rafts are so many, that even round ones "
      "would be less than the %.1f um across that light resolves: of vesicle '%s' at %.4g s %.2g "
      "um. Are the units right?",
      narrow.count, data.measurements.size(), kDiffraction, narrow.worst->vesicle.c_str(),
      narrow.worst->time, narrow.least);
}

std::string too_short_boundaries(const MeasuredVesicles& data) {
  constexpr double kTooShort = 0.9;
  const Impossible shorter = below(data, length_of, kTooShort);
  if (shorter.count == 0) return "";
  return formatted(
      "Of %td of %zu looks the perimeter is shorter than any boundary around the raft fraction, of "
      "vesicle '%s' at %.4g s %.2g times that of a single cap. Is the radius a diameter, or the "
      "perimeter divided by the radius already?",
      shorter.count, data.measurements.size(), shorter.worst->vesicle.c_str(), shorter.worst->time,
      shorter.least);
}

std::vector<std::string> doubts_about(const MeasuredVesicles& data) {
  std::vector<std::string> doubts;
  for (const std::string& doubt :
       {unusual_times(data), too_long_boundaries(data), too_short_boundaries(data)})
    if (!doubt.empty()) doubts.push_back(doubt);
  return doubts;
}

}  // namespace traceraft
