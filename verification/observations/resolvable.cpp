#include "verification/observations/resolvable.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/text.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::observations {
namespace {

constexpr double kDiffraction = 0.2;  // µm

// The diameter in µm of the rafts of a look if they are equal discs, by their boundaries (or of
// what is between them, of which a strip would be half as wide) or by their number. It is infinite
// where nothing tells.
double diameter_of(const Measurement& m) {
  const double fraction = m.of(Quantity::fraction).value_or(0.5);
  double diameter = HUGE_VAL;
  if (const double perimeter = m.of(Quantity::perimeter).value_or(0); perimeter > 0)
    diameter = 16 * kPi * std::min(fraction, 1 - fraction) / perimeter;
  if (const double rafts = m.of(Quantity::rafts).value_or(0); rafts > 0)
    diameter = std::min(diameter, 4 * std::sqrt(fraction / rafts));
  return diameter * m.radius;
}

// The length of the perimeter over the shortest that a raft fraction can have, that of a cap. It is
// the largest that errors of measuring allow, and infinite where nothing tells.
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
  return formatted("The last observation is %.3g s after time zero. Is time_unit right?", last);
}

std::string too_long_boundaries(const MeasuredVesicles& data) {
  const Impossible narrow = below(data, diameter_of, kDiffraction);
  if (narrow.count == 0) return "";
  return formatted(
      "In %td of %zu observations the perimeter is very long, or the rafts are very many. Even "
      "round rafts would then be smaller than the %.1f um that light resolves. The smallest, %.2g "
      "um, are those of vesicle '%s' at %.4g s. Are the units right?",
      narrow.count, data.measurements.size(), kDiffraction, narrow.least,
      narrow.worst->vesicle.c_str(), narrow.worst->time);
}

std::string too_short_boundaries(const MeasuredVesicles& data) {
  constexpr double kTooShort = 0.9;
  const Impossible shorter = below(data, length_of, kTooShort);
  if (shorter.count == 0) return "";
  return formatted(
      "In %td of %zu observations the perimeter is shorter than the shortest possible one, that of "
      "a single cap with this raft fraction. The shortest, %.2g times that of the cap, is that of "
      "vesicle '%s' at %.4g s. Is the radius a diameter, or is the perimeter already divided by "
      "the radius?",
      shorter.count, data.measurements.size(), shorter.least, shorter.worst->vesicle.c_str(),
      shorter.worst->time);
}

std::vector<std::string> doubts_about(const MeasuredVesicles& data) {
  std::vector<std::string> doubts;
  for (const std::string& doubt :
       {unusual_times(data), too_long_boundaries(data), too_short_boundaries(data)})
    if (!doubt.empty()) doubts.push_back(doubt);
  return doubts;
}

}  // namespace traceraft::observations
