// Tables of evenly spaced values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace traceraft::statistics {

// Linear between the values; `place`: from 0 to the number of the last one. Two values at least.
inline double interpolated(const std::vector<double>& values, double place) {
  const auto below = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const double share = place - static_cast<double>(below);
  return values[below] + share * (values[below + 1] - values[below]);
}

}  // namespace traceraft::statistics
