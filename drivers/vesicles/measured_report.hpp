// What measurements say, alone and beside an ensemble: tables, comparison.csv, comparison.html.
#pragma once

#include <filesystem>
#include <optional>

#include "verification/vesicles/measurements.hpp"
#include "verification/vesicles/power_law.hpp"
#include "verification/vesicles/published.hpp"

namespace traceraft {

// `law`: fitted within the window.
void print_dataset(const MeasuredVesicles& data, const std::optional<FittedLaw>& law,
                   const Window& window);

// The finished runs of an ensemble, in s and R, or what a folder with its config.toml and
// histories.csv has kept of them. Throws InputError if there is no ensemble, or if its times are in
// units of R²/D.
std::vector<History> runs_of(const std::filesystem::path& ensemble);

struct ComparisonRequest {
  std::filesystem::path ensemble, out;
  Window window;
  std::optional<PublishedFacts> facts;  // shown beside both
  bool quiet;
};
// Writes into the folder `out`. Returns an exit code; throws InputError as runs_of, and if fewer
// than two runs have finished.
int compare_with_ensemble(const MeasuredVesicles& data, const ComparisonRequest& request);

}  // namespace traceraft
