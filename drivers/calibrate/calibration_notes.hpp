// What is to be known beside the numbers of a calibration, in sentences.
#pragma once

#include "drivers/calibrate/calibration_findings.hpp"

namespace traceraft {

// What limits or spoils the result first, then what was found beyond the table of parameters.
std::vector<std::string> notes_on(const MeasuredVesicles& data, const CalibrationRuns& runs,
                                  const CalibrationFindings& found, const Calibration& result);

}  // namespace traceraft
