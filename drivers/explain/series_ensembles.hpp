// The simulations behind an explanation of series: an ensemble of the model, and one with each
// effect.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/explain/series_plan.hpp"
#include "verification/selection/series/series_explanation.hpp"

namespace traceraft::explain {

struct SeriesEnsemblesRequest {
  statistics::Window looks;  // s
  int runs, jobs, threads;
  std::vector<std::string> without;  // effects
  double kelvin;                     // of the measurements
  bool quiet;
};

struct SeriesEnsembles {
  std::filesystem::path folder;
  bool stopped = false;  // there is more to do
  std::vector<observations::History> base;
  std::vector<selection::SeriesCandidate> candidates;
  std::vector<PlannedEffect> effects;  // those of the candidates
  double kelvin = 0;                   // of Brownian motion
  std::vector<std::string> notes;      // effects whose runs failed
};

// Takes over the simulations of an earlier explanation, for other data: the looks that they are
// for, and how many runs. Throws InputError if there are none, or of another model.
void take_over_ensembles(const std::filesystem::path& folder, const config::Configuration& model,
                         SeriesEnsemblesRequest& request);

// If data are looked at when those effects had no time to act, or too much: a sentence, else "".
std::string note_on_looks(const statistics::Window& simulated, const statistics::Window& measured);

// The term, with this parameter drawn back into its range.
effects::EffectTerm within_range(effects::EffectTerm term, std::size_t parameter,
                                 const physics::Units& units);

// Throws InputError for data and models that cannot be used.
void refuse_series(const observations::MeasuredVesicles& data, const config::Configuration& model);

// Carries out, or goes on with, what is in the folder. Effects have the strengths of plan_effects;
// from then on signals to stop are caught (process.hpp). Throws InputError if no effect is left,
// NumericalFailure if a run of the model fails.
SeriesEnsembles run_series_ensembles(const std::filesystem::path& folder,
                                     const config::Configuration& model,
                                     const SeriesEnsemblesRequest& request);

}  // namespace traceraft::explain
