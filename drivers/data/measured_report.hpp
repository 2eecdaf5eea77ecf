// Reports on measurements, and the ensembles they are held against.
#pragma once

#include <filesystem>
#include <optional>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "verification/observations/measurements.hpp"
#include "verification/observations/perimeter_law.hpp"

namespace traceraft::data {

// Its name, and whether it was drawn rather than measured.
std::string title_of(const observations::MeasuredVesicles& data);
std::string origin_of(
    const observations::MeasuredVesicles& data);  // "measured", or that it was not
std::string about_data(
    const observations::MeasuredVesicles& data);  // a sentence: title, how many, from where

// `law`: fitted within the window.
void print_dataset(const observations::MeasuredVesicles& data,
                   const std::optional<observations::FittedLaw>& law,
                   const statistics::Window& window);

// The model of an ensemble, or of what a folder has kept of one. Throws InputError if there is
// none, or if its times are in units of R²/D.
config::Configuration model_of(const std::filesystem::path& ensemble);

struct EnsembleRuns {
  std::vector<observations::History> histories;  // in s and R
  std::string missing;  // "ONLY 2 OF 3 RUNS ...", why, and what to do; "" if all are there
};
// The finished runs of an ensemble, or what a folder with its config.toml and histories.csv has
// kept of them. Throws InputError as model_of.
EnsembleRuns runs_of(const std::filesystem::path& ensemble);

// The measurements over time (s), times `unit`.
bench::ChartSeries measured_points(const observations::MeasuredVesicles& data,
                                   observations::Quantity quantity, double unit = 1);

// Simulations, in s and R, and the measurements in them, from a tenth of the first measured time
// on.
bench::Chart comparison_chart(const observations::MeasuredVesicles& data,
                              const ensemble::EnsembleSummary& summary,
                              observations::Quantity quantity);

}  // namespace traceraft::data
