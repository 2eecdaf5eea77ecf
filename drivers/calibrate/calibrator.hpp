// Rounds of simulations, each where the fit to those before asks for them.
#pragma once

#include <filesystem>

#include "drivers/calibrate/calibration_points.hpp"
#include "verification/calibration/calibration.hpp"

namespace traceraft::calibrate {

// D is looked for up to this multiple of the model's, and runs go on as long; how small it may be
// costs nothing.
inline constexpr double kFastest = 4, kSlowest = 100;

// The end of the simulations (s): the latest measurement if D were as large as it may be.
double end_of_runs(const observations::MeasuredVesicles& data);

// Cells that a mesh may need with which the first choices around the model can be run, 128 at
// least.
int usual_most_cells(const config::Configuration& model);

struct CalibratorRequest {
  std::filesystem::path out;
  std::vector<std::string> names;  // of the parameters that cost simulations
  int most_cells;                  // of the mesh, a multiple of 4
  int runs, jobs, threads;         // of each choice; at a time; of each run, 0: what jobs leave
  bool quiet;
};

class Calibrator {
 public:
  // Request, data and model must outlive it.
  Calibrator(const CalibratorRequest& request, const observations::MeasuredVesicles& data,
             const config::Configuration& model)
      : request_(request), data_(data), model_(model) {}

  // Rounds of simulations and a fit after each. False if it was stopped. Throws InputError if too
  // few runs have finished.
  bool run();

  const calibration::Calibration& result() const { return result_; }
  const std::vector<calibration::CalibrationPoint>& points() const { return points_; }

 private:
  std::vector<calibration::SoughtParameter> sought() const;
  std::vector<double> within_range(std::vector<double> centre, double step) const;
  bool add_points(const std::vector<std::vector<double>>& design, int round);
  bool add_point(const std::vector<double>& ln, const std::string& number);
  std::string expected_time(const config::Configuration& here) const;  // for people; "" if unknown

  const CalibratorRequest& request_;
  const observations::MeasuredVesicles& data_;
  const config::Configuration& model_;
  std::vector<ensemble::PointEnd> ends_;
  std::vector<calibration::CalibrationPoint> points_;  // of them
  double seconds_per_work_ = 0;                        // of the last choice that was run as a whole
  calibration::Calibration result_;
};

}  // namespace traceraft::calibrate
