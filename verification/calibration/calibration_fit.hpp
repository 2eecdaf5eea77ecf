// The parameters that fit measurements best, and how they would scatter if these were made again.
#pragma once

#include <algorithm>

#include "verification/calibration/calibration.hpp"
#include "verification/calibration/joint_fit.hpp"

namespace traceraft::calibration {

// Where there are points, and `overshoot` of that beyond, as far as it is allowed.
Box explored(const std::vector<CalibrationPoint>& points,
             const std::vector<SoughtParameter>& sought, double overshoot);

// The estimates of ln R²/D and of ln of the parameters.
std::vector<double> estimates(const JointFit& fit);

class CalibrationFit {
 public:
  // The data and the unit must outlive it. Throws InputError as calibrate.
  CalibrationFit(const observations::MeasuredVesicles& data,
                 const std::vector<SoughtParameter>& sought,
                 const std::vector<CalibrationPoint>& points, const likelihood::UnitPrior& unit);

  // At each of the points that were given.
  const std::vector<JointFit>& at_points() const { return at_all_; }
  // Points that the data do not exclude: points far away would bend the emulator near the best one.
  const std::vector<CalibrationPoint>& points() const { return points_; }
  const JointFit& found() const { return found_; }
  // Units of time that are about as probable as that found, with the parameters found.
  statistics::Interval units() const;
  // Vesicles, or seeds if those are fewer: how much estimates scatter is known from so many.
  int samples() const { return std::min(static_cast<int>(vesicles_.size()), count_); }
  // Estimates from data that the model found would give, with other runs of the same kind.
  std::vector<std::vector<double>> replicates() const;

 private:
  Evidence evidence() const {
    return {likelihood::observed_series(data_, vesicles_, quantities_), unit_};
  }
  std::vector<statistics::Interval> probable_units() const;

  const observations::MeasuredVesicles& data_;
  const likelihood::UnitPrior& unit_;
  std::vector<int> vesicles_;
  std::vector<observations::Quantity> quantities_;
  int count_;  // of the runs of each point
  std::vector<JointFit> at_all_;
  std::vector<CalibrationPoint> points_;
  Box box_;
  RunEmulator runs_;
  std::vector<JointFit> at_points_;
  JointFit found_;
};

}  // namespace traceraft::calibration
