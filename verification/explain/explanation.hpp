// From measured fields to what the model is missing: the search for effects, one after the other.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel/geometry/level_set.hpp"
#include "kernel/observables/surface_view.hpp"
#include "verification/explain/bounds.hpp"
#include "verification/explain/disagreement.hpp"
#include "verification/explain/disagreement_map.hpp"
#include "verification/explain/judgement.hpp"

namespace traceraft {

struct ExplainRequest {
  CahnHilliardModel base;
  LevelSetPtr surface;
  int cells = 32;
  int threads = 2;
  FilterSettings filter;
  int most_effects = 3;
  std::vector<std::string> without;  // effects that are not looked for
  std::size_t shortlist = 5;
  bool hold_out = true;        // the last snapshot of vesicles that have four or more
  double false_alarms = 0.02;  // with nothing missing, the share of data sets that seem to lack
                               // something
  bool rerun = true;           // on another mesh and by another integrator
  std::function<void(const std::string& step)> progress = {};      // may be empty
  std::function<void(const struct SearchState& state)> save = {};  // after every round
};

// What was found, held against the data once more, on another mesh and by another integrator.
struct Rerun {
  int cells = 0;  // 0: there is none, as nothing was found
  std::string integrator;
  Gaps base, found, floor;  // in units of c
};

struct Explanation {
  Finding finding = Finding::none;
  int replicates = 0;                   // of noise that verdicts are judged by
  double noise = 0;                     // standard deviation of the values
  Refit base, found;                    // with the pace refitted; found: the base if none was
  std::vector<std::string> equivalent;  // effects that explain the data as well as the last found
  std::vector<Round> rounds;
  // Measured minus forecast, in units of c. Placebo: the second best of the first round. Floor:
  // what is to be expected of the found model if nothing else is missing.
  Gaps base_gap, found_gap, placebo_gap, floor;
  Rerun rerun;
  std::vector<Bound> bounds;                // of effects that were not found
  std::vector<Disagreement> disagreements;  // with the base, the significant ones
  SurfaceMesh map_mesh;                     // Γ_h of the model's mesh
  DisagreementMaps base_maps, found_maps;   // at its points
};

// Between two rounds: all that the search goes on from.
struct SearchState {
  Explanation so_far;
  std::vector<double> noise;  // of each vesicle
  bool more = true;           // is there another round?
};

// The gaps of a model that has these effects already, in units of c, and what is to be expected of
// them, in units of the noise.
struct ModelGaps {
  Gaps gap, expected;
};
ModelGaps gaps_of_model(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                        double pace, const std::vector<EffectTerm>& effects);

// Vesicles of one radius and one membrane. Throws std::runtime_error if the base model cannot be
// advanced.
// `saved`: of the same data and request.
Explanation explain_fields(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                           const std::optional<SearchState>& saved = {});

}  // namespace traceraft
