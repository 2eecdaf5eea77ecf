// What measurements say, alone and beside an ensemble: tables, comparison.csv, comparison.html.
#pragma once

#include <filesystem>
#include <optional>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "verification/vesicles/differences.hpp"
#include "verification/vesicles/measurements.hpp"
#include "verification/vesicles/power_law.hpp"
#include "verification/vesicles/published.hpp"

namespace traceraft {

// Its name, and whether it was drawn rather than measured.
std::string title_of(const MeasuredVesicles& data);

// `law`: fitted within the window.
void print_dataset(const MeasuredVesicles& data, const std::optional<FittedLaw>& law,
                   const Window& window);

// The model of an ensemble, or of what a folder has kept of one. Throws InputError if there is
// none, or if its times are in units of R²/D.
Configuration model_of(const std::filesystem::path& ensemble);

// The finished runs of an ensemble, in s and R, or what a folder with its config.toml and
// histories.csv has kept of them. Throws InputError as model_of.
std::vector<History> runs_of(const std::filesystem::path& ensemble);

// Simulations, in s and R, and the measurements in them, from a tenth of the first measured time
// on.
Chart comparison_chart(const MeasuredVesicles& data, const EnsembleSummary& summary,
                       Quantity quantity);

struct ComparisonRequest {
  std::filesystem::path ensemble, out;
  std::string command;  // that asks for it
  Window window;
  std::optional<PublishedFacts> facts;  // shown beside both
  bool quiet;
};
// Writes into the folder `out`. Returns an exit code; throws InputError as runs_of, and if fewer
// than two runs have finished.
int compare_with_ensemble(const MeasuredVesicles& data, const ComparisonRequest& request);

}  // namespace traceraft
