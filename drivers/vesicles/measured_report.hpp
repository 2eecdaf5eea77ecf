// What measurements say, alone and beside an ensemble: tables, comparison.csv, comparison.html.
#pragma once

#include <filesystem>
#include <optional>

#include "verification/vesicles/measurements.hpp"
#include "verification/vesicles/power_law.hpp"

namespace traceraft {

void print_dataset(const MeasuredVesicles& data, const std::optional<FittedLaw>& law);

// Writes into the folder of the ensemble. Returns an exit code; throws InputError if there is no
// ensemble with two finished runs at least, or if its times are in units of R²/D.
int compare_with_ensemble(const MeasuredVesicles& data, const std::filesystem::path& ensemble,
                          const Window& window, bool quiet);

}  // namespace traceraft
