// What a calibration found: a table, calibration.json, calibration.csv, calibrated.toml and a page.
#pragma once

#include <filesystem>

#include "drivers/config/configuration.hpp"
#include "verification/vesicles/calibration.hpp"

namespace traceraft {

// What was simulated, and how.
struct CalibrationRuns {
  const Configuration& model;
  std::vector<std::string> names;  // of the parameters of the points
  std::vector<CalibrationPoint> points;
  int most_cells;            // that simulations might have
  std::string command;       // that asks for it
  std::string bound;         // where the search for D ends, and what to do about it
  std::string missing = {};  // of an ensemble's runs, those that are not there
};

// calibrated.toml is the model with what was found.
void write_calibration(const std::filesystem::path& folder, const MeasuredVesicles& data,
                       const CalibrationRuns& runs, const Calibration& result, bool quiet);

}  // namespace traceraft
