// Simulations at a few choices of the parameters, and what they would have been at others.
#pragma once

#include <memory>
#include <vector>

#include "verification/likelihood/run_curves.hpp"

namespace traceraft::calibration {

// Simulations at one choice of the parameters that cost simulations. Parameters are logarithms.
struct CalibrationPoint {
  std::vector<double> ln_parameters;
  std::vector<observations::History> runs;  // in units of R²/D
};

// The mean curves are local parabolas of the parameters: they are smooth where deviances, which
// compare them with data, are flat in one place and steep in another. The scatter of runs is the
// mean over the points: the runs of one point alone know it badly.
class RunEmulator {
 public:
  // There have to be as many points as regression_weights wants, all with the same number of runs.
  explicit RunEmulator(const std::vector<CalibrationPoint>& points);
  // An emulator with other runs at each point, by the same weights, so that what seeds have in
  // common cancels in the comparison of points.
  RunEmulator with_others(const Eigen::MatrixXd& weights) const;

  const likelihood::RunCurves& at_point(std::size_t point) const { return at_points_[point]; }
  likelihood::RunCurves at(const std::vector<double>& ln_parameters) const;
  // Curves whose mean is the derivative of that by the i-th parameter.
  likelihood::RunCurves derivative(const std::vector<double>& ln_parameters, std::size_t i) const;

 private:
  void set_curves(const std::vector<likelihood::RunSamples>& samples);
  likelihood::RunCurves combined(const std::vector<double>& weights) const;

  std::vector<std::vector<double>> ln_parameters_;
  std::shared_ptr<std::vector<likelihood::RunSamples>> samples_;  // one per point
  std::vector<likelihood::RunCurves> at_points_;
};

}  // namespace traceraft::calibration
