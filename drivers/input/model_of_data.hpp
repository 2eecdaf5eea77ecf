// The model that measurements are to be held against.
#pragma once

#include <string>

#include "drivers/config/configuration.hpp"

namespace traceraft::input {

// The case of a membrane, such as 3:1:20; empty if there is none.
std::string case_of(const std::string& composition);

// Measurements are of one membrane, so that no case may be taken unasked. Throws InputError if
// neither a file of `--model` nor a case among the flags says which model is meant. `composition`:
// of the measurements, "" if it is not known.
void refuse_without_model(const std::string& composition, const std::string& model,
                          const config::GivenValues& flags);

// "3:1:20 (case guv-3to1), the measurements of 2:1:20", if the model is a case's, with its raft
// fraction, and its membrane another one than that of the measurements; "" otherwise.
std::string other_membrane(const std::string& composition, const config::Configuration& model);

}  // namespace traceraft::input
