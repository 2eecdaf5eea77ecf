// What is to be known beside the numbers of a calibration, in sentences.
#pragma once

#include "drivers/calibrate/calibration_findings.hpp"

namespace traceraft::calibrate {

// What limits or spoils the result first, then what was found beyond the table of parameters.
std::vector<std::string> notes_on(const observations::MeasuredVesicles& data,
                                  const CalibrationRuns& runs, const CalibrationFindings& found,
                                  const calibration::Calibration& result);

}  // namespace traceraft::calibrate
