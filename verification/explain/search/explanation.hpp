// From measured fields to what the model is missing: the search for effects, one after the other.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kernel/geometry/level_set.hpp"
#include "kernel/observables/surface_view.hpp"
#include "verification/explain/filter/disagreement.hpp"
#include "verification/explain/filter/disagreement_map.hpp"
#include "verification/explain/search/bounds.hpp"
#include "verification/explain/search/judgement.hpp"

namespace traceraft {

struct ExplainRequest {
  CahnHilliardModel base;
  Hypothesis own = {};  // effects that the model has: fitted as D is, and none that is missing
  LevelSetPtr surface;
  int cells = 32;
  int threads = 2;
  FilterSettings filter;
  int most_effects = 3;
  std::vector<std::string> without;  // effects that are not looked for
  std::size_t shortlist = 5;
  bool blur_stated = true;     // is it known whether the images are blurred (filter.blur)?
  bool hold_out = true;        // the last snapshot of vesicles that have four or more
  double false_alarms = 0.02;  // with nothing missing, the share of data sets that seem to lack
                               // something
  std::function<void(const std::string& step)> progress = {};      // may be empty
  std::function<void(const struct SearchState& state)> save = {};  // after every refit
};

// A snapshot that seems turned, or whose values seem to be on another scale: further than what is
// known of them allows for. What is within that is 0.
struct FrameChange {
  std::size_t vesicle, snapshot;
  double turn;          // since the snapshot before, as an angle
  double gain, offset;  // measured = (1 + gain) c + offset
};

// What was found, held against the data once more, on another mesh and by another integrator.
struct Rerun {
  int cells = 0;
  std::string integrator;
  Gaps base, found, floor;  // in units of c
  std::string failure;      // why there is none, if it failed
  // Of what is held out, or, if nothing is, of what was fitted: 2 ln of the likelihood ratio of
  // found and base, with the covariance that innovations have if the found model is the truth; by
  // how many standard deviations it is smaller than it would be then; and how many of them errors
  // of the mesh may be.
  double gain = 0, shortfall = 0, doubt = 0;
  // That what is left of a gap which nothing explains is noise; looked at if there is one, and why
  // not, if that failed.
  std::optional<double> gap_p = {};
  std::string gap_failure = {};

  bool heldout() const { return found.heldout > 0; }
  // Does it foretell better than the base? Without anything held out next to any model does.
  bool confirms() const { return failure.empty() && gain > 0; }
  bool refutes() const;
};

// A hypothesis that explains what counts as well as the found one, but not what is held out.
struct ToldApart {
  std::string effect;
  double less;  // 2 ln of how much less probable it is, with all that was measured
};

// A hypothesis that the search left for another one, by the names of its effects.
struct Turn {
  enum Why {
    replaced,  // by one near it, which is more probable
    left_gap,  // and one that explains what counts as well does not
    foretold,  // what is held out: the other one is more probable with all that was measured
    is_none    // an effect, beside the rest, with the noise of the model that has it
  };
  Why why;
  std::string from, to;
};

// A snapshot that has turned by more than errors of the state allow for, and was registered.
struct RegisteredTurn {
  std::size_t vesicle, snapshot;
  double angle;  // since the snapshot before
};

struct Explanation {
  Finding finding = Finding::none;
  Finding without_gap = Finding::none;      // if it is `unnamed`: what it is if that gap is none
  int replicates = 0;                       // of noise that verdicts are judged by
  double false_alarms = 0;                  // as requested
  double noise = 0;                         // standard deviation of the values that count
  std::vector<std::vector<double>> noises;  // of each vesicle's snapshots, in units of deviations
  NoiseCorrelation correlation;             // of that noise
  Refit base, found;                        // with the pace refitted; found: the base if none was
  std::vector<Refit> rivals;                // other hypotheses that explain the data as well
  std::vector<ToldApart> told_apart;
  std::vector<Turn> turns;  // in their order
  std::vector<Round> rounds;
  // Measured minus forecast. Placebo: the best other hypothesis, a rival or of the last round that
  // had one. Floor: what is to be expected of the found model if nothing else is missing.
  Gaps base_gap, found_gap, floor;
  std::optional<Gaps> placebo_gap;
  bool blur_stated = true;                                      // as requested
  double pace_doubt = std::numeric_limits<double>::infinity();  // as requested
  double h_over_epsilon = 0;                                    // of the model's mesh
  std::size_t outliers = 0;                                     // values that were left out
  std::vector<FrameChange> changes;                             // of the found model
  std::vector<RegisteredTurn> registered;
  std::string stopped;                      // why the search could not go on, if it had to stop
  std::optional<Rerun> rerun;               // by run_again
  std::vector<Bound> bounds;                // of effects that were not found
  std::vector<Disagreement> disagreements;  // with the base, the significant ones
  SurfaceMesh map_mesh;                     // Γ_h of the model's mesh
  DisagreementMaps base_maps, found_maps;   // at its points
};

// A D that is further from the model's than by this factor is most likely a wrong unit of time.
inline constexpr double kFarPace = 10;

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
std::optional<Gaps> placebo_of(const Explanation& found);
// Names of the hypotheses that explain the data as well as each other, the found one first; none if
// nothing is named.
std::vector<std::string> class_of(const Explanation& found);

// All that the search goes on from: what was found up to the last round, and what the one that is
// not over has of refits.
struct SearchState {
  Explanation so_far;
  std::vector<std::vector<double>> noise;  // of each vesicle, of each snapshot
  NoiseCorrelation correlation;            // of that
  bool more = true;                        // is there another round?
  bool told_apart = false;                 // has what is held out been asked about the class?
  std::map<std::size_t, Refit> ahead;      // by their number in the round
};

FilterProblems problems_of(const std::vector<FieldSeries>& series, const ExplainRequest& request);

// Vesicles of one radius and one membrane. Throws std::runtime_error if the base model cannot be
// advanced.
// `saved`: of the same data and request.
Explanation explain_fields(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                           const std::optional<SearchState>& saved = {});

}  // namespace traceraft
