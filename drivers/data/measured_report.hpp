// What measurements say, and the ensembles they are held against.
#pragma once

#include <filesystem>
#include <optional>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "verification/observations/measurements.hpp"
#include "verification/observations/perimeter_law.hpp"

namespace traceraft {

// Its name, and whether it was drawn rather than measured.
std::string title_of(const MeasuredVesicles& data);
std::string origin_of(const MeasuredVesicles& data);   // "measured", or that it was not
std::string about_data(const MeasuredVesicles& data);  // a sentence: title, how many, from where

// `law`: fitted within the window.
void print_dataset(const MeasuredVesicles& data, const std::optional<FittedLaw>& law,
                   const Window& window);

// The model of an ensemble, or of what a folder has kept of one. Throws InputError if there is
// none, or if its times are in units of R²/D.
Configuration model_of(const std::filesystem::path& ensemble);

struct EnsembleRuns {
  std::vector<History> histories;  // in s and R
  std::string missing;  // "ONLY 2 OF 3 RUNS ...", why, and what to do; "" if all are there
};
// The finished runs of an ensemble, or what a folder with its config.toml and histories.csv has
// kept of them. Throws InputError as model_of.
EnsembleRuns runs_of(const std::filesystem::path& ensemble);

// The measurements over time (s), times `unit`.
ChartSeries measured_points(const MeasuredVesicles& data, Quantity quantity, double unit = 1);

// Simulations, in s and R, and the measurements in them, from a tenth of the first measured time
// on.
Chart comparison_chart(const MeasuredVesicles& data, const EnsembleSummary& summary,
                       Quantity quantity);

}  // namespace traceraft
