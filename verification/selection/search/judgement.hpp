// Judgement of a search for one more effect: what it has found, and what follows from it.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "verification/selection/fit/refit.hpp"
#include "verification/selection/fit/score_test.hpp"

namespace traceraft::selection {

enum class Finding {
  none,              // no significant disagreement
  named,             // one effect, or several, that leave no significant disagreement
  ambiguous,         // like it, but another one explains the data as well
  below_resolution,  // what would explain the data could be the error of the model's own mesh
  not_identifiable,  // no disagreement, but effects of the usual size would not be seen either, or
                     // D itself; or one that is too small to tell which effect it is
  unnamed            // a significant disagreement that no candidate explains
};
// Are there effects that belong to the model?
inline bool is_named(Finding finding) {
  return finding == Finding::named || finding == Finding::ambiguous;
}
inline constexpr std::array kFindings{Finding::none,
                                      Finding::named,
                                      Finding::ambiguous,
                                      Finding::below_resolution,
                                      Finding::not_identifiable,
                                      Finding::unnamed};
std::string word_for(Finding finding);
// The finding of a hypothesis with so many rivals that explain the data as well.
inline Finding finding_beside(std::size_t rivals) {
  return rivals == 0 ? Finding::named : Finding::ambiguous;
}

// The search for one more effect.
struct Round {
  assimilation::FilterModel known;
  Screening screening;
  Refit without;              // what was known before
  std::vector<Refit> refits;  // of the shortlist, most probable first; none if nothing is lacking
  struct Failure {
    std::string effect, why;
  };
  std::vector<Failure> failures;  // what could not be refitted
  std::vector<Refit> moves;       // near what was taken then, with effects replaced or dropped
};

// 2 ln of a likelihood ratio of 20: less does not tell two hypotheses apart.
inline constexpr double kTelling = 6;
// Standard deviations that an effect has to have to be seen in nine cases of ten.
inline constexpr double kSeen = 4;

// Standard deviation of ln D beyond which the data say too little of how fast anything happens: D
// is known to a factor of 3 at best, in 95 of 100 cases. Rafts at rest are such data.
inline constexpr double kKineticsUntested = 0.56;
inline bool tests_kinetics(const Refit& base) {
  return base.diffusion_ratio_deviation <= kKineticsUntested;
}

// Schwarz' (1978): an effect with a second coefficient has to earn it, above all if one without is
// a special case of it. `values`: how many have been measured.
double criterion(const Refit& fit, double values);

// Is it the best fit with a coefficient that has no use: one of which that is a special case, and
// which gains less than 2 (Akaike 1974)?
bool is_no_other(const Refit& fit, const Refit& best);

// Does it explain the data as well as the best fit? `limit`: what tells the two apart.
bool explains_as_well(const Refit& fit, const Refit& best, double values, double limit);

// The error that extrapolation to finer meshes may have, in standard deviations of everything
// measured together: kMeshDoubt of its last part, whose root mean square is `mesh_error` in units
// of the noise.
double mesh_doubt(double values, double mesh_error);

// Deviances further apart tell two hypotheses apart: by noise, and even if that error had the very
// shape of what distinguishes them.
double discrimination_limit(double values, double mesh_error);

// Is an effect so certain that noise and what extrapolation to finer meshes may be wrong by could
// not look like it, even if that had its very shape?
bool resolved(const Refit& fit, std::size_t effect, double values, double mesh_error);
bool all_resolved(const Refit& fit, double values, double mesh_error);

const std::string& last_effect(const assimilation::Hypothesis& hypothesis);

// A gap of any shape has to be that much less probable than the best candidate, as it names
// nothing, and as what is left of the errors of the mesh and of linear responses looks like one: of
// 179 models that held the truth it found p < 0.01 in seven, and p < 0.002 in one
// (docs/explain.md).
inline constexpr double kGapLevel = 0.1;

// Is there a gap of any shape?
bool has_gap(const Screening& screening, double false_alarms);

// The finding of something that is missing and has no name.
Finding without_name(const Screening& screening, double false_alarms);

struct Judgement {
  bool taken;                           // the best refit's effect belongs to the model
  Finding finding;                      // of the search up to now
  Finding without_gap;                  // the same, if there were no gap of any shape
  std::vector<std::string> equivalent;  // hypotheses that explain the data as well, best first
};
// `false_alarms`: the share of data sets with nothing missing that may seem to lack something;
// `usual_change`: of c that an effect makes, in units of the noise; `leaves_gap`: is there a gap
// beside that model, too? It is asked where there is one beside what is known, and the best
// candidate could be the mesh: that is to be doubted only if it would explain what is missing.
Judgement judge(const Round& round, double values, double false_alarms, double usual_change,
                const std::function<bool(const Refit&)>& leaves_gap);

}  // namespace traceraft::selection
