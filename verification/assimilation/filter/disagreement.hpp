// Where measurements and forecasts disagree: when, on which side of the vesicle, and inside rafts,
// outside or at their boundaries.
#pragma once

#include <string>
#include <vector>

#include "kernel/physics/double_well.hpp"
#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::assimilation {

// The middles of twelve patches of a closed surface: the corners of an icosahedron, as unit
// vectors.
std::vector<Point> patch_middles();
std::size_t nearest_patch(const std::vector<Point>& middles, const Point& x);

struct Disagreement {
  std::size_t vesicle;
  double time;
  std::string state;  // "inside rafts", "boundary", "outside rafts"
  Point direction;    // of the middle of the patch
  double z;           // measured minus forecast, in its standard deviations
  double p;           // of a |z| like that by noise, from the spread over the replicates
};

// All of 12 patches × 3 states × snapshots, held out or not, that hold at least 10 values, the most
// significant first. `data`: what the result is of.
std::vector<Disagreement> disagreements(const FilterProblems& data, const FilterResult& result,
                                        const physics::DoubleWell& well);

// How many of them are significant if a share of `level` of those may be false (Benjamini and
// Hochberg 1995).
std::size_t significant(const std::vector<Disagreement>& sorted, double level);

}  // namespace traceraft::assimilation
