// What a calibration found: a table, calibration.json, calibration.csv, calibrated.toml and a page.
#pragma once

#include <filesystem>

#include "drivers/config/configuration.hpp"
#include "verification/vesicles/calibration.hpp"

namespace traceraft {

// `names` of the parameters of the points. calibrated.toml is the model with what was found.
void write_calibration(const std::filesystem::path& folder, const MeasuredVesicles& data,
                       const Configuration& model, const std::vector<std::string>& names,
                       const std::vector<CalibrationPoint>& points, const Calibration& result,
                       bool quiet);

}  // namespace traceraft
