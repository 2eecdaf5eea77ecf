// How many vesicles it takes to see an effect in series.
#pragma once

#include "verification/selection/series/series_gains.hpp"

namespace traceraft::selection {

// Beyond so many times as many vesicles nothing is said.
inline constexpr int kMostTimes = 8;

// The mean gain of noise by an effect. It grows with the number of vesicles, as what all of them
// have in common is seen better, too: the model's mean is that of a few runs.
struct SeriesNoise {
  double now,  // for as many vesicles as there are
      most;    // for kMostTimes as many
};

// The gains of noise, one per candidate, from data of the base model with as many looks each.
// `null`: what is known of the vesicles that there are.
std::vector<SeriesNoise> noise_of_more(const observations::MeasuredVesicles& data,
                                       const std::vector<observations::History>& runs,
                                       const std::vector<SeriesCandidate>& candidates,
                                       const likelihood::EnsembleFit& fit,
                                       const likelihood::UnitPrior& unit, const SeriesNull& null);

// Inner products over the looks that there are; e: what an effect does, u: what another D does.
struct SeriesProducts {
  double ee, ue, uu;
  double known;  // what is known of D before: the inverse of the variance of ln D
};

// How many times as many vesicles make the square of the effect kSeen² times what noise gains, and
// that at least 1, no more being known of D before, to 1 %; infinite: more than kMostTimes, or
// none.
double times_needed(const SeriesProducts& products, const SeriesNoise& noise);

}  // namespace traceraft::selection
