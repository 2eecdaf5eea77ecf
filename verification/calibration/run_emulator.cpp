#include "verification/calibration/run_emulator.hpp"

#include <algorithm>

#include "verification/calibration/local_regression.hpp"

namespace traceraft::calibration {
namespace {

// Width of the neighbourhood in which curves are parabolas, in ln of the parameters.
constexpr double kWidth = 0.5;

likelihood::RunScatter mean_scatter(const std::vector<likelihood::RunSamples>& samples) {
  const double share = 1 / static_cast<double>(samples.size());
  likelihood::RunScatter mean = samples.front().scatter();
  for (std::size_t q = 0; q < observations::kQuantities.size(); ++q) {
    std::vector<double>& variance = mean.variance[q];
    std::fill(variance.begin(), variance.end(), 0);
    mean.correlation[q] = 0;
  }
  for (const likelihood::RunSamples& runs : samples) {
    const likelihood::RunScatter more = runs.scatter();
    for (std::size_t q = 0; q < observations::kQuantities.size(); ++q) {
      mean.correlation[q] += share * more.correlation[q];
      for (std::size_t i = 0; i < more.variance[q].size(); ++i)
        mean.variance[q][i] += share * more.variance[q][i];
    }
  }
  return mean;
}

}  // namespace

RunEmulator::RunEmulator(const std::vector<CalibrationPoint>& points)
    : samples_(std::make_shared<std::vector<likelihood::RunSamples>>()) {
  std::vector<observations::History> all;
  for (const CalibrationPoint& point : points)
    all.insert(all.end(), point.runs.begin(), point.runs.end());
  const std::vector<double> times = observations::common_times(all, observations::kCurveTimes);
  for (const CalibrationPoint& point : points) {
    ln_parameters_.push_back(point.ln_parameters);
    samples_->emplace_back(point.runs, times);
  }
  set_curves(*samples_);
}

RunEmulator RunEmulator::with_others(const Eigen::MatrixXd& weights) const {
  std::vector<likelihood::RunSamples> others;
  for (const likelihood::RunSamples& samples : *samples_) others.push_back(samples.others(weights));
  RunEmulator result = *this;
  result.set_curves(others);
  return result;
}

likelihood::RunCurves RunEmulator::at(const std::vector<double>& ln_parameters) const {
  return combined(regression_weights(ln_parameters_, ln_parameters, kWidth));
}

likelihood::RunCurves RunEmulator::derivative(const std::vector<double>& ln_parameters,
                                              std::size_t i) const {
  constexpr double kStep = 1e-4;
  std::vector<double> above = ln_parameters, below = ln_parameters;
  above[i] += kStep;
  below[i] -= kStep;
  std::vector<double> weights = regression_weights(ln_parameters_, above, kWidth);
  const std::vector<double> less = regression_weights(ln_parameters_, below, kWidth);
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[k] = (weights[k] - less[k]) / (2 * kStep);
  return combined(weights);
}

// All points have the same scatter.
likelihood::RunCurves RunEmulator::combined(const std::vector<double>& weights) const {
  std::vector<const likelihood::RunCurves*> all;
  for (const likelihood::RunCurves& curves : at_points_) all.push_back(&curves);
  const auto count = static_cast<Eigen::Index>(weights.size());
  return likelihood::RunCurves::combined(all, Eigen::Map<const Vec>(weights.data(), count),
                                         Vec::Unit(count, 0));
}

void RunEmulator::set_curves(const std::vector<likelihood::RunSamples>& samples) {
  const likelihood::RunScatter scatter = mean_scatter(samples);
  at_points_.clear();
  for (const likelihood::RunSamples& runs : samples)
    at_points_.emplace_back(runs.times(), runs.means(), scatter, runs.count());
}

}  // namespace traceraft::calibration
