// From measured fields to what the model is missing: the question, and its answer.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kernel/geometry/level_set.hpp"
#include "kernel/observables/surface_view.hpp"
#include "verification/assimilation/filter/disagreement.hpp"
#include "verification/assimilation/filter/disagreement_map.hpp"
#include "verification/assimilation/filter/noise_levels.hpp"
#include "verification/selection/search/bounds.hpp"
#include "verification/selection/search/judgement.hpp"

namespace traceraft::selection {

struct SearchState;

struct ExplainRequest {
  problem::CahnHilliardModel base;
  assimilation::Hypothesis own =
      {};  // effects that the model has: fitted as D is, and none that is missing
  geometry::LevelSetPtr surface;
  int cells = 32;
  int threads = 2;
  assimilation::FilterSettings filter;
  int most_effects = 3;
  std::vector<std::string> without;  // effects that are not looked for
  std::size_t shortlist = 5;
  bool blur_stated = true;     // is it known whether the images are blurred (filter.blur)?
  bool hold_out = true;        // the last snapshot of vesicles that have four or more
  bool confirm = true;         // repeat what was found on another mesh by another integrator
  double false_alarms = 0.02;  // with nothing missing, the share of data sets that seem to lack
                               // something
  std::function<void(const std::string& news)> progress = {};  // may be empty
  // Called after every step of the search, and after every refit; may be empty.
  std::function<void(const SearchState& state)> save = {};
};

// A snapshot that seems rotated, or whose values seem to be on another scale: further than what is
// known of them allows for. What is within that is 0.
struct FrameChange {
  std::size_t vesicle, snapshot;
  double rotation;      // since the snapshot before, as an angle
  double gain, offset;  // measured = (1 + gain) c + offset
};

// A snapshot that is rotated by more than errors of the state allow for, and was registered.
struct RegisteredRotation {
  std::size_t vesicle, snapshot;
  double angle;  // since the snapshot before
};

// The found model, held against the data once more, on another mesh and by another integrator.
struct Rerun {
  int cells = 0;
  std::string integrator;
  assimilation::Gaps base, found, floor;  // in units of c
  std::string failure;                    // why there is none, if it failed
  // All three are of what is held out or, if nothing is, of what was fitted. `gain`: 2 ln of the
  // likelihood ratio of found and base, with the covariance that innovations have if the found
  // model is the truth. `shortfall`: standard deviations by which the gain is smaller than it would
  // be then. `doubt`: standard deviations that errors of the mesh may be.
  double gain = 0, shortfall = 0, doubt = 0;
  // p of a gap which nothing explains, if the search left one; and why it is not known, if so.
  std::optional<double> gap_p = {};
  std::string gap_failure = {};

  bool heldout() const { return found.heldout > 0; }
  // Does it foretell better than the base? Without anything held out next to any model does.
  bool confirms() const { return failure.empty() && gain > 0; }
  bool refutes() const;
};

// A hypothesis that explains what counts as well as the found one, but not what is held out.
struct Excluded {
  std::string effect;
  double less;  // difference of Schwarz' criterion, with all that was measured
};

// The search left one hypothesis for another, by the names of their effects.
struct ModelChange {
  enum Reason {
    replaced,  // by one near it, which is more probable
    left_gap,  // and one that explains what counts as well does not
    foretold,  // what is held out: the other one is more probable with all that was measured
    is_none    // an effect, beside the rest, with the noise of the model that has it
  };
  Reason reason;
  std::string from, to;
};

struct Explanation {
  Finding finding = Finding::none;
  Finding without_gap = Finding::none;  // if it is `unnamed`: what it is if that gap is none
  double false_alarms = 0;              // as requested
  double diffusion_ratio_doubt = std::numeric_limits<double>::infinity();  // as requested
  double h_over_epsilon = 0;                                               // of the model's mesh
  std::size_t outliers = 0;  // values that were left out
  bool at_rest = false;      // data and base model (rest.hpp), so that nothing was fitted
  std::vector<RegisteredRotation> registered;
  double noise = 0;  // standard deviation of the values that count
  assimilation::NoiseModel noise_model;
  Refit base, found;          // with D refitted; found: the base if nothing was
  std::vector<Refit> rivals;  // other hypotheses that explain the data as well
  std::vector<Excluded> excluded;
  std::vector<ModelChange> changes;  // in their order
  std::vector<Round> rounds;
  std::string stopped;              // why the search could not go on, if it had to stop
  std::vector<FrameChange> frames;  // of the found model
  std::vector<assimilation::Disagreement> disagreements;  // with the base, the significant ones
  observables::SurfaceMesh map_mesh;  // Γ_h of the model's mesh; no part of a saved state
  assimilation::DisagreementMaps base_maps, found_maps;  // at its points
  std::optional<Rerun> rerun;
};

// A D that is further from the model's than by this factor is most likely a wrong unit of time.
inline constexpr double kFarDiffusionRatio = 10;

// Beyond that h/epsilon verdicts become doubtful: at 1.7 one of eleven campaign cases with nothing
// missing was `not-identifiable` (docs/explain.md).
inline constexpr double kCoarse = 1.5;

// Did the search find effects that belong to the model?
bool is_named(const Explanation& found);
// The share of what was left of the gap that the last round has closed, of the snapshots that
// count; nothing before a round is over, or where so little was left that it may be noise.
std::optional<double> closed_by_last_round(const Explanation& found);
// A search goes on only while rounds close at least that share: models that lack something with no
// name else collect effects that each explain next to nothing of it.
inline constexpr double kLeastProgress = 0.1;
// The gaps of the best rival, or of the best of the last round that had others than the found one
// or that with something more: by their gaps, as deviances of different rounds are in units of
// different noise.
std::optional<assimilation::Gaps> runner_up(const Explanation& found);
// How strong effects beside those that were found may be; none where nothing was looked for.
std::vector<Bound> bounds_of(const Explanation& found);
// Names of the hypotheses that explain the data as well as each other, the found one first; none if
// nothing is named.
std::vector<std::string> class_of(const Explanation& found);

}  // namespace traceraft::selection
