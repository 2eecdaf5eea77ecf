#include "drivers/calibrate/calibration_notes.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/calibrate/calibration_points.hpp"
#include "drivers/data/agreement_report.hpp"
#include "kernel/core/text.hpp"
#include "verification/calibration/calibration_data.hpp"
#include "verification/observations/differences.hpp"

namespace traceraft::calibrate {
namespace {

constexpr double kAtEnd = 1.01;      // of a range
constexpr double kNoScatter = 0.01;  // standard deviation that is not worth a word

// Choices at which there mostly is nothing to compare.
int choices_without_rafts(const observations::MeasuredVesicles& data, const CalibrationRuns& all,
                          const calibration::Calibration& result) {
  constexpr double kMost = 0.5;
  int count = 0;
  for (std::size_t k = 0; k < all.points.size(); ++k)
    count += observations::share_without_rafts(data, runs_in_seconds(all, result, k)) > kMost;
  return count;
}

using Notes = std::vector<std::string>;

// Where the search for parameters ended.
void add_search(const CalibrationRuns& runs, const calibration::Calibration& result, Notes& notes) {
  if (!runs.missing.empty()) notes.push_back(runs.missing);
  if (!result.converged)
    notes.push_back(
        "NOT CONVERGED: the last simulations do not surround the parameters that were found. Start "
        "again from the calibrated model.");
  if (result.unit_at_bound)
    notes.push_back("D IS NOT KNOWN: it lies at the end of the range searched. " + runs.bound);
  else if (result.at_bound > 0)
    notes.push_back(formatted("For %d of %zu choices of the other parameters, the best D lies at "
                              "the end of the range searched. ",
                              result.at_bound, runs.points.size()) +
                    runs.bound);
}

// Measurements and choices of parameters that say nothing.
void add_unused(const observations::MeasuredVesicles& data, const CalibrationRuns& runs,
                const calibration::Calibration& result, Notes& notes) {
  if (const int nothing = calibration::looks_that_tell_nothing(data); nothing > 0)
    notes.push_back(
        formatted("%d of %zu observations are not used: they are at time zero, show no raft, or "
                  "have neither perimeter nor number of rafts.",
                  nothing, data.measurements.size()));
  if (const int choices = choices_without_rafts(data, runs, result); choices > 0)
    notes.push_back(
        formatted("For %d of %zu choices of parameters, the simulated vesicles have no rafts at "
                  "the times of observation. These choices say nothing about D.",
                  choices, runs.points.size()));
}

// Notes on the limit of ε, and on a noise length that was not to be fitted.
void add_limits(const CalibrationRuns& runs, const calibration::Calibration& result, Notes& notes) {
  for (const calibration::CalibratedParameter& p : result.parameters) {
    if (p.name != "epsilon") continue;
    const double smallest = range_of(runs.model, p.name, runs.most_cells).low;
    if (p.interval.low < kAtEnd * smallest)
      notes.push_back(
          formatted("Epsilon may be smaller than %.3g um, the smallest value that %d cells resolve "
                    "and the end of the range searched. Choose more --most-cells.",
                    smallest, runs.most_cells));
  }
  if (!runs.names.empty() &&
      std::find(runs.names.begin(), runs.names.end(), "noise-length") == runs.names.end())
    notes.push_back(
        "The intervals assume that the length of the initial noise is that of the model. Otherwise "
        "the other parameters are biased. Add noise-length to --parameters to fit it.");
}

// The flags of a mesh that is as fine in units of ε on a vesicle that is larger by `factor`.
std::string mesh_of_larger(const config::Configuration& model, double factor) {
  const double cells = factor * static_cast<double>(model.options().cells);
  return model.options().mesh == "adaptive"
             ? formatted(" --mesh adaptive --cells %.0f", config::cells_that_double(cells))
             : formatted(" --cells %.0f", std::round(cells));
}

void add_size(const observations::MeasuredVesicles& data, const CalibrationRuns& runs,
              const calibration::Calibration& result, Notes& notes) {
  const double radius = runs.model.units().length();
  const double factor = observations::factor_of_size(data, radius);
  if (const calibration::CalibratedParameter& unit = result.parameters.front();
      unit.determined && !size_is_told(factor, unit.interval))
    notes.push_back("THE SIZE OF THE VESICLES DECIDES ABOUT D. " +
                    observations::effect_of_size(data, radius) +
                    mesh_of_larger(runs.model, std::pow(factor, 0.25)) + ".");
}

// For readers: what was found beyond the table.
void add_findings(const calibration::Calibration& result, Notes& notes) {
  if (const std::string best = best_known(result); !best.empty())
    notes.push_back("The data determine best: " + best + ".");
  const double scatter = result.best.scatter_beyond_runs(observations::Quantity::perimeter);
  notes.push_back(scatter > kNoScatter
                      ? formatted("Beyond the scatter between runs, perimeters scatter by %.0f %%.",
                                  100 * scatter)
                      : "Perimeters scatter no more than those of the runs.");
}

}  // namespace

std::vector<std::string> notes_on(const observations::MeasuredVesicles& data,
                                  const CalibrationRuns& runs, const CalibrationFindings& found,
                                  const calibration::Calibration& result) {
  Notes notes;
  add_search(runs, result, notes);
  add_unused(data, runs, result, notes);
  add_limits(runs, result, notes);
  add_size(data, runs, result, notes);
  for (const std::string& note :
       data::cautions(data, runs.model.units().length(), found.best, found.agreements))
    notes.push_back(note);
  add_findings(result, notes);
  return notes;
}

}  // namespace traceraft::calibrate
