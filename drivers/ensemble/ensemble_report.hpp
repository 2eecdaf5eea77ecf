// The report of an ensemble: ensemble.csv and ensemble.html.
#pragma once

#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_folder.hpp"
#include "drivers/ensemble/ensemble_runs.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/text_table.hpp"
#include "verification/bench/figures.hpp"
#include "verification/observations/history.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::ensemble {

// Per quantity its distribution over the runs, at common times.
struct EnsembleSummary {
  std::size_t runs;
  std::vector<double> times;
  std::array<std::vector<statistics::Sample>, 3> at;  // in the order of kQuantities
};
// Throws InputError if they have no times in common.
EnsembleSummary summarise(const std::vector<observations::History>& runs);

// A row per time: t, and for every quantity its mean, deviation, extrema and quantiles.
bench::Table ensemble_table(const EnsembleSummary& summary);
// A few times, for people. `seconds`: are times in seconds?
std::vector<output::Row> ensemble_rows(const EnsembleSummary& summary, bool seconds);
// Range, quartiles and median of a quantity over time. `seconds`: are times in seconds?
bench::Chart ensemble_chart(const EnsembleSummary& summary, observations::Quantity quantity,
                            bool seconds);

// All settings of the runs, and the command that makes them again.
void add_ensemble_origin(output::Page& page, const EnsembleFolder& folder,
                         const config::Configuration& configuration);

// Writes both files into the folder and prints a table unless `quiet`. Returns what is missing of
// the charts, "" if nothing.
std::string write_ensemble(const EnsembleFolder& folder, const config::Configuration& configuration,
                           const EnsembleSummary& summary, const EnsembleEnd& end, bool quiet);

}  // namespace traceraft::ensemble
