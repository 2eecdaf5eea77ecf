// A calibration reported: a table, calibration.json, calibration.csv, calibrated.toml and a page.
#pragma once

#include <filesystem>

#include "drivers/calibrate/calibration_findings.hpp"

namespace traceraft::calibrate {

// calibrated.toml is the model with what was found.
void write_calibration(const std::filesystem::path& folder,
                       const observations::MeasuredVesicles& data, const CalibrationRuns& runs,
                       const calibration::Calibration& result, bool quiet);

}  // namespace traceraft::calibrate
