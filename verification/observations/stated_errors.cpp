#include "verification/observations/stated_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "verification/observations/mean_of_logarithm.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::observations {
namespace {

constexpr double kRoundingVariance = 1 / 12.0;  // of whole numbers
constexpr double kLeastSpread = 1e-6;           // of ln of the values
// The change of ln of a value that noise may make: that many standard deviations, and at most a
// factor of two.
constexpr double kByNoise = 2, kMostByNoise = 0.7;

}  // namespace

StatedErrors::StatedErrors(const MeasuredVesicles& data) {
  for (const Quantity quantity : kQuantities) laws_[index_of(quantity)] = law_of(data, quantity);
}

StatedErrors::Law StatedErrors::law_of(const MeasuredVesicles& data, Quantity quantity) {
  statistics::Points points;
  std::vector<double> ln_values, ln_sigmas;
  for (const Measurement& m : data.measurements) {
    const double value = m.of(quantity).value_or(0), sigma = m.sigma_of(quantity);
    if (!(m.time > 0) || !(value > 0) || !(sigma > 0)) continue;
    ln_values.push_back(std::log(value));
    ln_sigmas.push_back(std::log(sigma));
    points.emplace_back(ln_values.back(), ln_sigmas.back());
  }
  if (points.empty()) return {};
  const statistics::Sample values = statistics::sample_of(ln_values);
  const double power = values.deviation < kLeastSpread
                           ? 0.0
                           : std::clamp(statistics::fit_line(points).slope, 0.0, 1.0);
  return {power, statistics::sample_of(ln_sigmas).mean - power * values.mean};
}

StatedError StatedErrors::of(const Measurement& m, Quantity quantity) const {
  const auto& [power, ln_scale] = law(quantity);
  const bool counted = quantity == Quantity::rafts;
  const double value = m.of(quantity).value_or(0), sigma = m.sigma_of(quantity);
  if (!(sigma > 0)) return {-std::numeric_limits<double>::infinity(), power, counted};
  if (!(value > 0)) return {std::log(sigma), 0, counted};
  const double usual = ln_scale + power * std::log(value);
  const double by_noise = power * std::min(kByNoise * std::exp(usual) / value, kMostByNoise);
  const double other = std::log(sigma) - usual;
  return {ln_scale + (std::fabs(other) > by_noise ? other : 0), power, counted};
}

double StatedError::stated(double ln_expected) const {
  return std::exp(2 * (ln_sigma + (power - 1) * ln_expected));
}

double StatedError::of_logarithm(double ln_expected) const {
  return counted ? std::max(stated(ln_expected), kRoundingVariance * std::exp(-2 * ln_expected))
                 : stated(ln_expected);
}

double StatedError::bias(double ln_expected) const {
  if (!std::isfinite(ln_sigma)) return 0;
  const double s = std::sqrt(stated(ln_expected));
  return counted ? mean_of_count_logarithm(std::exp(ln_expected), s, power)
                 : mean_of_logarithm(s, power);
}

// An error that goes with v^b is that of a normal v^(1 − b), or of a normal ln v.
double StatedError::drawn(double ln_value,
                          const std::function<double(std::uint64_t)>& normal) const {
  const double absolute = 1 - power, s = std::sqrt(stated(ln_value));
  if (is_relative(power)) return ln_value + s * normal(0);
  for (std::uint64_t k = 0;; ++k)
    if (const double error = absolute * s * normal(k); error > -1)
      return ln_value + std::log1p(error) / absolute;
}

}  // namespace traceraft::observations
