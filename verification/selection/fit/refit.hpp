// The most probable coefficients of a hypothesis: no longer to first order, but with forecasts by
// the model that has the effects.
#pragma once

#include <functional>

#include "verification/assimilation/filter/gaps.hpp"

namespace traceraft::selection {

struct Refit {
  assimilation::Hypothesis hypothesis;
  double diffusion_ratio = 1;  // D over that of the base model
  // −2 ln of the likelihood, at its least, diffusion ratio and mesh being free.
  double deviance = 0;
  // Covariance of the coefficients, coefficients × coefficients, diffusion ratio and mesh being
  // free. That of rates is in units of time that do not change with the diffusion ratio.
  Eigen::MatrixXd covariance;
  double diffusion_ratio_deviation = 0;  // standard deviation of ln diffusion ratio
  // `gap`: measured minus forecast. `expected`: the gap that is to be expected if nothing is
  // missing, by the noise and by what it leaves unknown of the state.
  assimilation::Gaps gap, expected;
  assimilation::Gaps random = {};  // the part of `expected` that random effects make
  // −2 ln of the likelihood without random effects, over that with them, all else being the same.
  double random_gain = 0;
  std::vector<assimilation::SnapshotGap> snapshots;  // the same, one by one
  bool settled = true;                               // was the search for the coefficients over?
  std::string failure;  // why a forecast failed, if it did: no refit then
};

// The shares of a base's gaps that a refit closes. A random effect makes a gap that no forecast
// closes: that part of it is explained.
assimilation::SharesClosed shares_closed(const Refit& base, const Refit& fit);

// (coefficients)ᵀ C⁻¹ (coefficients) of one of its effects, with their covariance C: what its
// absence costs in deviance, to first order, all else being free. That of a random effect is what
// it costs.
double certainty(const Refit& fit, std::size_t effect);

// The better one of a refit and the one without its last effect, which is a refit of the same
// hypothesis, too: with an effect of strength 0.
Refit no_worse(const Refit& fit, const Refit& without);

// Gauss and Newton's method with halved steps, from the coefficients and the diffusion ratio of
// `start`, until what is left to go is a small part of the standard deviation. Unstable trial
// models count as improbable; where even `start` is, its coefficients are halved until it is none.
// Coefficients stay within the range that their effect has.
Refit refit(const assimilation::FilterProblems& data, const assimilation::FilterModel& start,
            const assimilation::FilterSettings& settings,
            const std::vector<assimilation::ErrorMaps>& maps);

// The refits of many models, on all processors, in the order of `starts`. `done` is called after
// each, with its place among them, one at a time.
std::vector<Refit> refit_each(const assimilation::FilterProblems& data,
                              const std::vector<assimilation::FilterModel>& starts,
                              const assimilation::FilterSettings& settings,
                              const std::vector<assimilation::ErrorMaps>& maps,
                              const std::function<void(std::size_t, const Refit&)>& done);

// The covariance that the replicates of a pass with the (refitted) model have, to first order: a
// parametric bootstrap.
void bootstrap(const assimilation::FilterResult& pass, const assimilation::FilterModel& model,
               Refit& fit);

}  // namespace traceraft::selection
