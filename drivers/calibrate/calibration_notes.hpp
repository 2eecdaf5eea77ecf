// Notes on a calibration: sentences to be known beside its numbers.
#pragma once

#include "drivers/calibrate/calibration_findings.hpp"

namespace traceraft::calibrate {

// Notes on what limits or spoils the result, then on findings beyond the table of parameters.
std::vector<std::string> notes_on(const observations::MeasuredVesicles& data,
                                  const CalibrationRuns& runs, const CalibrationFindings& found,
                                  const calibration::Calibration& result);

}  // namespace traceraft::calibrate
