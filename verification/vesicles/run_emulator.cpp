#include "verification/vesicles/run_emulator.hpp"

#include "verification/vesicles/local_regression.hpp"

namespace traceraft {
namespace {

// Of the neighbourhood in which curves are parabolas, in ln of the parameters.
constexpr double kWidth = 0.5;

}  // namespace

RunEmulator::RunEmulator(const std::vector<CalibrationPoint>& points, const ScatterLaws& scatter)
    : scatter_(scatter), curves_(std::make_shared<std::vector<SampledRuns>>()) {
  std::vector<History> all;
  for (const CalibrationPoint& point : points)
    all.insert(all.end(), point.runs.begin(), point.runs.end());
  const std::vector<double> times = common_times(all, kCurveTimes);
  for (const CalibrationPoint& point : points) {
    ln_parameters_.push_back(point.ln_parameters);
    curves_->emplace_back(point.runs, times);
    at_points_.emplace_back(curves_->back(), each_once(point.runs.size()), scatter_);
  }
}

RunEmulator RunEmulator::with_runs(const std::vector<int>& sample) const {
  RunEmulator result = *this;
  result.at_points_.clear();
  for (const SampledRuns& curves : *curves_)
    result.at_points_.emplace_back(curves, sample, scatter_);
  return result;
}

RunStatistics RunEmulator::at(const std::vector<double>& ln_parameters) const {
  return RunStatistics::combined(at_points_,
                                 regression_weights(ln_parameters_, ln_parameters, kWidth));
}

}  // namespace traceraft
