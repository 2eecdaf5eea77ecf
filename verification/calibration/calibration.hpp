// Parameters of the model from measurements: what they are, how well the data determine them, and
// which combinations they do not.
#pragma once

#include <string>
#include <vector>

#include "kernel/core/types.hpp"
#include "verification/calibration/run_emulator.hpp"
#include "verification/likelihood/ensemble_fit.hpp"
#include "verification/statistics/bootstrap.hpp"

namespace traceraft::calibration {

// A parameter that is looked for besides the unit of time, and the values that it may have.
struct SoughtParameter {
  std::string name;
  statistics::Interval allowed;
};

// Factor between the ends of an interval, below which a parameter is determined.
inline constexpr double kDetermined = 2;

struct CalibratedParameter {
  std::string name;
  double value;
  // 95 %, by what data of the model found would give, with other vesicles and runs; widened for
  // few. Both are corrected for the bias that such data show.
  statistics::Interval interval;
  bool within;      // the interval ends within what was explored
  bool determined;  // it does, and spans less than kDetermined
};

struct Calibration {
  std::vector<CalibratedParameter> parameters;     // R²/D in seconds first
  Eigen::MatrixXd correlation;                     // of the logarithms, in the same order
  std::vector<likelihood::EnsembleFit> at_points;  // where each of them fits best
  likelihood::EnsembleFit best;                    // the most probable fit
  // The best determined product of powers, of D first, the largest power being 1, and its relative
  // deviation.
  std::vector<double> best_powers;
  double best_deviation;
  int at_bound;           // points at which R²/D fits best where the search for it ends
  bool unit_at_bound;     // does it fit best there at all?
  bool converged = true;  // do the last simulations surround what was found?
};

// Marks an estimate that the simulations do not surround: nothing of it is determined.
void mark_unconverged(Calibration& calibration);

// ln of the most probable parameters but the unit of time: near what calibrate finds, without
// saying how certain it is.
std::vector<double> most_probable(const observations::MeasuredVesicles& data,
                                  const std::vector<SoughtParameter>& sought,
                                  const std::vector<CalibrationPoint>& points,
                                  const likelihood::UnitPrior& unit);

// The parameters of the measurements, with simulations in between the points emulated from these.
// All points have as many runs. Throws InputError if they are too few, and as telling_vesicles.
Calibration calibrate(const observations::MeasuredVesicles& data,
                      const std::vector<SoughtParameter>& sought,
                      const std::vector<CalibrationPoint>& points,
                      const likelihood::UnitPrior& unit);

// Where simulations are needed next: a star around the centre with steps of `step` in ln, and for
// two parameters or more the corners that a parabola needs.
std::vector<std::vector<double>> design_around(const std::vector<double>& centre, double step);

}  // namespace traceraft::calibration
