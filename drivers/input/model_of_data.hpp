// Which model measurements are to be held against.
#pragma once

#include <string>

#include "drivers/config/configuration.hpp"
#include "verification/vesicles/measurements.hpp"

namespace traceraft {

// The case of a membrane, such as 3:1:20; empty if there is none.
std::string case_of(const std::string& composition);

// Measurements are of one membrane, so that no case may be taken unasked. Throws InputError if
// neither a file of `--model` nor a case among the flags says which model is meant.
void refuse_without_model(const MeasuredVesicles& data, const std::string& model,
                          const GivenValues& flags);

}  // namespace traceraft
