// The units of numbers in files and on pages.
#pragma once

#include <string>

namespace traceraft::text {

enum class Unit { count, ratio, time, length, area, seconds, megabytes };

// "um^2", or "R^2" where inputs and outputs are scaled; "" of a count or a ratio. The energy is an
// area: it is measured in units of the energy density.
std::string unit_name(Unit unit, bool scaled);

// A heading with its unit, as in "t (s)", and the name in such a heading. A unit that the program
// does not write stays part of the name, so that nobody's minutes are taken for seconds.
std::string with_unit(const std::string& name, Unit unit, bool scaled);
std::string without_unit(const std::string& heading);

}  // namespace traceraft::text
