#include "verification/vesicles/measurements.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/types.hpp"

namespace traceraft {

std::vector<std::pair<std::size_t, std::size_t>> MeasuredVesicles::vesicles() const {
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    if (i == 0 || measurements[i].vesicle != measurements[i - 1].vesicle) ranges.emplace_back(i, i);
    ranges.back().second = i + 1;
  }
  return ranges;
}

Window looks(const MeasuredVesicles& data) {
  Window window{HUGE_VAL, 0};
  for (const Measurement& m : data.measurements) {
    if (m.time > 0) window.begin = std::min(window.begin, m.time);
    window.end = std::max(window.end, m.time);
  }
  return window;
}

std::vector<std::optional<double>> mean_fractions(const MeasuredVesicles& data) {
  std::vector<std::optional<double>> means;
  for (const auto& [first, last] : data.vesicles()) {
    double sum = 0, count = 0;
    for (std::size_t i = first; i < last; ++i)
      if (const auto& value = data.measurements[i].of(Quantity::fraction)) {
        sum += *value;
        ++count;
      }
    means.push_back(count > 0 ? std::optional(sum / count) : std::nullopt);
  }
  return means;
}

void set_caps(Measurement& measurement, const std::vector<double>& base_radii) {
  const double r = measurement.radius;
  double perimeter = 0, area = 0;
  for (const double a : base_radii) {
    perimeter += 2 * kPi * a;
    area += 2 * kPi * r * r * (1 - std::cos(std::asin(a / r)));
  }
  measurement.values = {perimeter / r, static_cast<double>(base_radii.size()),
                        area / (4 * kPi * r * r)};
}

double equal_caps(double perimeter, double fraction) {
  return fraction + perimeter * perimeter / (16 * kPi * kPi * fraction);
}

}  // namespace traceraft
