// From measured fields to what the model is missing: the search for effects, one after the other.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernel/geometry/level_set.hpp"
#include "verification/explain/disagreement.hpp"
#include "verification/explain/refit.hpp"
#include "verification/explain/score_test.hpp"

namespace traceraft {

enum class Finding {
  none,              // no significant disagreement
  named,             // one effect, or several, that leave no significant disagreement
  ambiguous,         // like it, but another one explains the data as well
  below_resolution,  // what would explain the data changes less than the model's own mesh does
  unnamed            // a significant disagreement that no candidate explains
};
std::string word_for(Finding finding);

struct ExplainRequest {
  CahnHilliardModel base;
  LevelSetPtr surface;
  int cells = 32;
  int threads = 2;
  FilterSettings filter;
  int most_effects = 3;
  std::vector<std::string> without;  // effects that are not looked for
  std::size_t shortlist = 5;
  bool hold_out = true;        // the last snapshot, where there are four or more
  double false_alarms = 0.02;  // with nothing missing, the share of data sets that seem to lack
                               // something
  std::function<void(const std::string& step)> progress = {};  // may be empty
};

// The search for one more effect.
struct Round {
  FilterModel known;
  Screening screening;
  Refit without;              // what was known before
  std::vector<Refit> refits;  // of the shortlist, most probable first; none if nothing is lacking
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
  std::vector<Disagreement> disagreements;  // with the base, the significant ones
};

// The gaps of a model that has these effects already, in units of c.
Gaps gaps_of_model(const FieldSeries& series, const ExplainRequest& request, double pace,
                   const std::vector<EffectTerm>& effects);

// Throws std::runtime_error if the base model cannot be advanced.
Explanation explain_fields(const FieldSeries& series, const ExplainRequest& request);

}  // namespace traceraft
