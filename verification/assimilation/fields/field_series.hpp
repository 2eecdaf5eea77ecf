// Measured fields: c at scattered points of a vesicle, at a few times.
#pragma once

#include <string>
#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft::assimilation {

// Times in units of R²/D of the model, places in units of R.

// How far off the surface a place may be; the nearest point of the surface is then meant.
inline constexpr double kOffSurface = 0.1;

// The length in R over which neighbours may share noise at most: further than that it would be
// taken for what a model lacks, and that for noise.
inline constexpr double kLongestCorrelation = 0.14;

struct FieldSnapshot {
  double time;
  std::vector<Point> points;
  Vec values;     // of c; noise is independent between snapshots
  Vec deviation;  // standard deviations relative to each other; all 1 if they are alike
};

struct FieldSeries {
  std::string vesicle;
  std::vector<FieldSnapshot> snapshots;  // in the order of time, at least two
};

}  // namespace traceraft::assimilation
