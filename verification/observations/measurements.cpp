#include "verification/observations/measurements.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/types.hpp"

namespace traceraft::observations {

std::vector<std::pair<std::size_t, std::size_t>> MeasuredVesicles::vesicles() const {
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    if (i == 0 || measurements[i].vesicle != measurements[i - 1].vesicle) ranges.emplace_back(i, i);
    ranges.back().second = i + 1;
  }
  return ranges;
}

statistics::Window looks(const MeasuredVesicles& data) {
  statistics::Window window{HUGE_VAL, 0};
  for (const Measurement& m : data.measurements) {
    if (m.time > 0) window.begin = std::min(window.begin, m.time);
    window.end = std::max(window.end, m.time);
  }
  return window;
}

std::vector<std::optional<FractionOfVesicle>> fractions_of_vesicles(const MeasuredVesicles& data) {
  std::vector<std::optional<FractionOfVesicle>> all;
  for (const auto& [first, last] : data.vesicles()) {
    FractionOfVesicle fraction{0, {}};
    for (std::size_t i = first; i < last; ++i)
      if (const auto& value = data.measurements[i].of(Quantity::fraction);
          value && data.measurements[i].time > 0) {
        fraction.mean += *value;
        fraction.times.push_back(data.measurements[i].time);
      }
    fraction.mean /= static_cast<double>(fraction.times.size());
    all.push_back(fraction.times.empty() ? std::nullopt : std::optional(fraction));
  }
  return all;
}

namespace {

// (1 − cos θ)/2 with sin θ = a/r.
double cap_fraction(double a, double r) {
  return (1 - std::sqrt(1 - a * a / (r * r))) / 2;
}

// By the mean slope within one sigma: at a = r, half of the sphere, there is no derivative.
double cap_fraction_sigma(double a, double sigma, double r) {
  const double low = std::max(a - sigma, 0.0), high = std::min(a + sigma, r);
  if (!(high > low)) return 0;
  return sigma * (cap_fraction(high, r) - cap_fraction(low, r)) / (high - low);
}

}  // namespace

void set_caps(Measurement& measurement, const std::vector<Cap>& caps) {
  const double r = measurement.radius;
  double perimeter = 0, fraction = 0, perimeter_squares = 0, fraction_squares = 0;
  bool known = !caps.empty();
  for (const auto& [a, sigma] : caps) {
    perimeter += 2 * kPi * a / r;
    fraction += cap_fraction(a, r);
    known = known && sigma.has_value();
    if (!known) continue;
    perimeter_squares += std::pow(2 * kPi * *sigma / r, 2);
    fraction_squares += std::pow(cap_fraction_sigma(a, *sigma, r), 2);
  }
  measurement.values = {perimeter, static_cast<double>(caps.size()), fraction};
  if (known)
    measurement.sigma = {std::sqrt(perimeter_squares), std::nullopt, std::sqrt(fraction_squares)};
}

double equal_caps(double perimeter, double fraction) {
  return fraction + perimeter * perimeter / (16 * kPi * kPi * fraction);
}

}  // namespace traceraft::observations
