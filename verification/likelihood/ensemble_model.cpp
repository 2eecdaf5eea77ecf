#include "verification/likelihood/ensemble_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traceraft::likelihood {
namespace {

// Polynomials of Hermite on [0, 1], for both values and both slopes, or their derivatives.
struct HermiteBasis {
  double left, left_slope, right, right_slope;
};
HermiteBasis hermite_values(double x) {
  return {1 + x * x * (2 * x - 3), x * (1 + x * (x - 2)), x * x * (3 - 2 * x), x * x * (x - 1)};
}
HermiteBasis hermite_derivatives(double x) {
  return {6 * x * (x - 1), 1 + x * (3 * x - 4), 6 * x * (1 - x), x * (3 * x - 2)};
}

// The interval between two levels that holds an amplitude.
Eigen::Index interval_of(double amplitude, Eigen::Index count) {
  return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(amplitude)), 0, count - 2);
}

// Adds a multiple of the slope at level k: half the difference of its neighbours, one-sided at both
// ends.
void add_slope(Eigen::Index k, double factor, Vec& weights) {
  const Eigen::Index before = std::max<Eigen::Index>(k - 1, 0),
                     after = std::min(k + 1, weights.size() - 1);
  weights[after] += factor / static_cast<double>(after - before);
  weights[before] -= factor / static_cast<double>(after - before);
}

Vec cubic_weights(double amplitude, Eigen::Index count, HermiteBasis (*basis)(double)) {
  Vec weights = Vec::Zero(count);
  if (count == 1) return Vec::Ones(1);
  const Eigen::Index k = interval_of(amplitude, count);
  const HermiteBasis h = basis(amplitude - static_cast<double>(k));
  weights[k] += h.left;
  weights[k + 1] += h.right;
  add_slope(k, h.left_slope, weights);
  add_slope(k + 1, h.right_slope, weights);
  return weights;
}

// Weights of levels near an amplitude, which sum to 1, and their derivatives by it.
struct NearLevels {
  Vec value, slope;
};
NearLevels near_levels(double amplitude, Eigen::Index count) {
  constexpr double kWidth = 1.5;  // in levels
  const Eigen::ArrayXd off =
      (Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(count - 1)) - amplitude) / kWidth;
  const Eigen::ArrayXd bell = (-0.5 * off.square()).exp(), slope = bell * off / kWidth;
  return {bell / bell.sum(), (slope - bell * slope.sum() / bell.sum()) / bell.sum()};
}

}  // namespace

EnsembleModel::EnsembleModel(const RunCurves* base, std::vector<const RunCurves*> levels,
                             bool two_sided)
    : curves_(std::move(levels)), two_sided_(two_sided) {
  curves_.insert(curves_.begin(), base);
}

double EnsembleModel::least_amplitude() const {
  return has_effect() && !has_several_levels() && two_sided_ ? -kLargestAmplitude : 0;
}

double EnsembleModel::largest_amplitude() const {
  if (!has_effect()) return 0;
  return has_several_levels() ? static_cast<double>(curves_.size() - 1) : kLargestAmplitude;
}

RunCurves EnsembleModel::at(double amplitude) const {
  const auto count = static_cast<Eigen::Index>(curves_.size());
  return RunCurves::combined(
      curves_, cubic_weights(amplitude, count, hermite_values),
      has_several_levels() ? near_levels(amplitude, count).value : Vec::Unit(count, 0));
}

RunCurves EnsembleModel::by_amplitude(double amplitude) const {
  const auto count = static_cast<Eigen::Index>(curves_.size());
  return RunCurves::combined(
      curves_, cubic_weights(amplitude, count, hermite_derivatives),
      has_several_levels() ? near_levels(amplitude, count).slope : Vec::Zero(count));
}

}  // namespace traceraft::likelihood
