// How far measurements lie from forecasts, how far they should, and what a better model closes of
// it.
#pragma once

#include <optional>
#include <vector>

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::assimilation {

// Root mean squares in c: of the snapshots that count, and of those that are held out (0: none is).
struct Gaps {
  double train = 0, heldout = 0;
};

// The share of what the base lacks that was closed, in mean squares, at most 1: more is noise.
// Nothing where the base is within 2 % of the floor, which it may be by noise.
std::optional<double> share_closed(double base, double found, double floor);
struct SharesClosed {
  std::optional<double> train, heldout;
};
SharesClosed shares_closed(const Gaps& base, const Gaps& found, const Gaps& floor);

struct SnapshotGap {
  std::size_t vesicle, snapshot;
  double gap, expected;  // root mean squares
};

// Measured minus forecast.
Gaps gaps_of_pass(const FilterResult& pass);
Gaps expected_gaps(const FilterResult& pass);  // if nothing is missing
Gaps random_gaps(const FilterResult& pass);    // the part of these that random effects make

std::vector<SnapshotGap> snapshot_gaps(const FilterResult& pass);

}  // namespace traceraft::assimilation
