#include "verification/vesicles/resolvable.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/text.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {
namespace {

constexpr double kDiffraction = 0.2;  // µm

// Of the rafts of a look if they are equal discs, or of what is between them; infinite where
// nothing tells. A strip would be half as wide.
double diameter_of(const Measurement& m) {
  const auto perimeter = m.of(Quantity::perimeter);
  if (!perimeter || !(*perimeter > 0)) return HUGE_VAL;
  const double fraction = m.of(Quantity::fraction).value_or(0.5);
  const double area = 4 * kPi * std::min(fraction, 1 - fraction);
  return 4 * area / *perimeter * m.radius;
}

}  // namespace

std::string too_long_boundaries(const MeasuredVesicles& data) {
  const auto& all = data.measurements;
  const auto narrow = std::count_if(
      all.begin(), all.end(), [](const Measurement& m) { return diameter_of(m) < kDiffraction; });
  if (narrow == 0) return "";
  const Measurement& worst = *std::min_element(
      all.begin(), all.end(),
      [](const Measurement& a, const Measurement& b) { return diameter_of(a) < diameter_of(b); });
  return formatted(
      "Of %td of %zu looks the perimeter is so long that even round rafts would be less than the "
      "%.1f um across that light resolves: of vesicle '%s' at %.4g s %.2g um. Are the units right?",
      narrow, all.size(), kDiffraction, worst.vesicle.c_str(), worst.time, diameter_of(worst));
}

}  // namespace traceraft
