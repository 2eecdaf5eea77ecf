// The findings of a calibration: D and the other parameters, whether the data determine them, and
// the runs that fit best.
#pragma once

#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/input/json_file.hpp"
#include "verification/calibration/calibration.hpp"
#include "verification/observations/comparison.hpp"

namespace traceraft::calibrate {

// The simulations of a calibration, and how they were made.
struct CalibrationRuns {
  const config::Configuration& model;
  std::vector<std::string> names;  // of the parameters of the points
  std::vector<calibration::CalibrationPoint> points;
  int most_cells;            // that simulations might have
  std::string command;       // that asks for it
  std::string bound;         // where the search for D ends, and what to do about it
  std::string missing = {};  // of an ensemble's runs, those that are not there
};

struct CalibrationFinding {
  std::string name, unit;
  double value, low, high;        // the interval of 95 %
  std::vector<std::string> open;  // why the data do not determine it, if they do not

  bool determined() const { return open.empty(); }
};

struct CalibrationFindings {
  std::vector<CalibrationFinding> parameters;       // "mobility", D in cm²/s, first
  std::vector<observations::History> best;          // the runs that fit best, in seconds
  std::vector<observations::Agreement> agreements;  // of the measurements with these
};

// Vesicles of another size, or that coarsen otherwise, determine nothing about D.
CalibrationFindings findings_of(const observations::MeasuredVesicles& data,
                                const CalibrationRuns& runs,
                                const calibration::Calibration& result);

// D in cm²/s from R²/D in seconds.
double diffusion(const config::Configuration& model, double seconds_per_unit);

// Is D known better than `factor`, what the size of the vesicles makes of it?
bool size_is_told(double factor, const statistics::Interval& seconds_per_unit);

// The runs of a choice, at the D that fits these.
std::vector<observations::History> runs_in_seconds(const CalibrationRuns& all,
                                                   const calibration::Calibration& result,
                                                   std::size_t choice);

// Why the fit to the data does not determine the parameter, which is one of `result`; empty if it
// does. What findings_of() adds for D needs the data.
std::vector<std::string> why_undetermined(const calibration::CalibratedParameter& parameter,
                                          const calibration::Calibration& result);

// The product of powers of D and the parameters that the data know best; "" where the search did
// not converge or an interval reaches its end, as what does is known no better than that.
std::string best_known(const calibration::Calibration& result);

// The model as a configuration, with the parameters that were found.
config::Configuration found_model(const CalibrationRuns& runs,
                                  const std::vector<CalibrationFinding>& parameters);

// calibration.json: see docs/formats.md.
input::Json calibration_json(const std::vector<CalibrationFinding>& parameters,
                             const calibration::Calibration& result);

}  // namespace traceraft::calibrate
