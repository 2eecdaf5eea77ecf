// An ensemble held against measurements: tables, comparison.csv, comparison.json, comparison.html.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "verification/observations/measurements.hpp"
#include "verification/observations/perimeter_law.hpp"
#include "verification/observations/published.hpp"

namespace traceraft::data {

struct ComparisonRequest {
  std::filesystem::path ensemble, out;
  std::string command;  // that asks for it
  statistics::Window window;
  std::optional<observations::PublishedFacts> facts;  // shown beside both
  bool quiet;
};
// Writes into the folder `out`. Returns an exit code; throws InputError as runs_of, and if fewer
// than two runs have finished.
int compare_with_ensemble(const observations::MeasuredVesicles& data,
                          const ComparisonRequest& request);

}  // namespace traceraft::data
