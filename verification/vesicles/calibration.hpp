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

// What is looked for besides the unit of time, and what it may be.
struct SoughtParameter {
  std::string name;
  Interval allowed;
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
  int at_bound;           // points at which R²/D fits best where the search for it ends
  bool converged = true;  // do the last simulations surround what was found?
};

// Of an estimate that the simulations do not surround nothing is determined.
void mark_unconverged(Calibration& calibration);

// Throws InputError for too few vesicles, and if neither perimeters nor rafts were measured.
void refuse_calibration(const MeasuredVesicles& data);

// Fits a parabola to the deviance of the points. Throws InputError if there are too few of them,
// and as refuse_calibration.
Calibration calibrate(const MeasuredVesicles& data, const std::vector<SoughtParameter>& sought,
                      const std::vector<CalibrationPoint>& points, const TimeUnit& unit);

// Where simulations are needed next: a star around the centre with steps of `step` in ln, and for
// two parameters or more the corners that a parabola needs.
std::vector<std::vector<double>> design_around(const std::vector<double>& centre, double step);

}  // namespace traceraft
