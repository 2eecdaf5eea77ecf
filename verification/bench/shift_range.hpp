// The shifts over which iterations are counted.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace traceraft::bench {

// Those of the fastest and of the slowest steps, in units of D/R²: eight decades.
inline std::vector<double> shift_range() {
  std::vector<double> shifts;
  for (int power = 5; power >= -3; --power) shifts.push_back(std::pow(10.0, power));
  return shifts;
}

// Names of columns, one for each.
inline std::string shift_label(double shift) {
  return "s=1e" + std::to_string(std::lround(std::log10(shift)));
}

}  // namespace traceraft::bench
