// Parameters of the model from measurements: what they are, how well the data determine them, and
// which combinations they do not.
#pragma once

#include <string>
#include <vector>

#include "kernel/core/types.hpp"
#include "verification/measure/fit.hpp"
#include "verification/vesicles/likelihood.hpp"

namespace traceraft {

// Simulations at one choice of the parameters that cost simulations. Parameters are logarithms.
struct CalibrationPoint {
  std::vector<double> ln_parameters;
  std::vector<History> runs;  // in units of R²/D
};

struct CalibratedParameter {
  std::string name;
  double value;
  Interval interval;  // 95 %, by the bootstrap over vesicles and over runs
  bool determined;    // the interval is narrower than a factor of 2 and within what was explored
};

struct Calibration {
  std::vector<CalibratedParameter> parameters;  // R²/D in seconds first
  Eigen::MatrixXd correlation;                  // of the logarithms, in the same order
  std::vector<TimeFit> at_points;
  double scatter;  // of ln perimeter, of the measurements
  // The best determined product of powers, of D first, the largest power being 1, and its relative
  // deviation.
  std::vector<double> best_powers;
  double best_deviation;
};

// `names` of the parameters of the points; `seconds_start`, `range` as of fit_time. Fits a parabola
// to the deviance of the points. Throws InputError if there are too few points or vesicles.
Calibration calibrate(const MeasuredVesicles& data, const std::vector<std::string>& names,
                      const std::vector<CalibrationPoint>& points, double seconds_start,
                      double range);

// Where simulations are needed next: a star around the centre with steps of `step` in ln, and for
// two parameters or more the corners that a parabola needs.
std::vector<std::vector<double>> design_around(const std::vector<double>& centre, double step);

}  // namespace traceraft
