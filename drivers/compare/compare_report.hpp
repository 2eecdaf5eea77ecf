// The report of a comparison: a table, compare.csv and compare.html.
#pragma once

#include <string>
#include <vector>

#include "drivers/compare/comparison.hpp"

namespace traceraft::compare {

void print_points(const std::vector<bench::WorkPoint>& points);

// Writes compare.csv and compare.html with its charts into the folder. `about` says what was
// compared with what.
void write_report(const ComparisonFolder& folder, const std::vector<bench::WorkPoint>& points,
                  const bench::Recommendation& advice, const std::vector<std::string>& about);

}  // namespace traceraft::compare
