// Messages on numbers on the command line that are none, or out of range.
#pragma once

#include <CLI/CLI.hpp>

namespace traceraft::config {

CLI::Validator between(double low, double high);  // both ends are allowed
CLI::Validator at_least(double low);
CLI::Validator positive();

// Before ranges are looked at: is it a finite number at all, and where that is asked for a whole
// one? CLI11's ranges let "nan" pass, since it compares false with both ends, and call "1e3" out of
// range where a whole number is asked for.
void check_numbers_first(CLI::App& command);

}  // namespace traceraft::config
