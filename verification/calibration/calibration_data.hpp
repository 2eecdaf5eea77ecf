// The part of the measurements that a calibration can use.
#pragma once

#include <vector>

#include "verification/observations/measurements.hpp"

namespace traceraft::calibration {

// Numbers of the vesicles that show rafts whose perimeter or number was measured after time zero.
// Throws InputError if they are fewer than three, or if there is no look after time zero.
std::vector<int> telling_vesicles(const observations::MeasuredVesicles& data);
// Measurements of time zero, without a raft, or of neither perimeter nor number: they are not used.
int looks_that_tell_nothing(const observations::MeasuredVesicles& data);

}  // namespace traceraft::calibration
