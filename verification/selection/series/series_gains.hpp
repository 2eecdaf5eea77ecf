// How much better each effect explains series than the model without it, and how much of that is to
// be expected of vesicles that lack nothing.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "verification/likelihood/ensemble_fit.hpp"
#include "verification/selection/series/series_candidate.hpp"
#include "verification/selection/series/series_misfit.hpp"

namespace traceraft::selection {

// The samples of each ensemble, at the times that all of them cover.
struct SeriesSamples {
  likelihood::RunSamples base;
  std::vector<std::vector<likelihood::RunSamples>> levels;  // of each candidate

  SeriesSamples(const std::vector<observations::History>& runs,
                const std::vector<SeriesCandidate>& candidates);
};

// The curves of each ensemble.
class SeriesCurves {
 public:
  SeriesCurves(const SeriesSamples& samples, const std::vector<SeriesCandidate>& candidates);
  // The curves of other runs, with the same weights in all ensembles.
  SeriesCurves(const SeriesSamples& samples, const std::vector<SeriesCandidate>& candidates,
               const Eigen::MatrixXd& weights);

  likelihood::RunCurves base;
  // With a candidate, whose curves must not move while the model is used.
  likelihood::EnsembleModel with(std::size_t candidate) const;
  const likelihood::RunCurves& level(std::size_t candidate, std::size_t number) const {
    return levels_[candidate][number];
  }

 private:
  std::vector<std::vector<likelihood::RunCurves>> levels_;
  std::vector<bool> two_sided_;
};

struct SeriesGains {
  likelihood::EnsembleFit base;
  std::vector<likelihood::EnsembleFit> fits;  // with each candidate
  Vec values;                                 // 2 ln of the likelihood ratios, one per candidate
  double trend;                               // left of the base
  std::vector<SeriesOffset> offsets;          // of the data beside the base
};
// `base`: the fit of the model without any effect.
SeriesGains gains_of(const std::vector<likelihood::ObservedSeries>& blocks,
                     const SeriesCurves& curves, std::size_t candidates,
                     const likelihood::UnitPrior& unit, const likelihood::EnsembleFit& base);

// The gains of data that the base model would give.
struct SeriesNull {
  Vec mean;     // of each candidate's gain, half a unit at least
  Vec trend;    // of each replicate: what is left of the base
  Vec ln_unit;  // of each replicate: that of the base
  // Root mean squares over the replicates, one per quantity. They are more than 1, as the model's
  // mean is that of a few runs.
  std::array<double, observations::kQuantities.size()>
      levels{},           // of SeriesOffset's level_deviations
      slopes{};           // of its slope_deviations
  Eigen::MatrixXd gains;  // a row per replicate, a column per candidate
};

// −ln of how often noise gains as much. Candidates that are adaptable gain more by it: a gamma
// distribution stands for what each of them gains, of data and replicates alike. If the data have
// no signal they are one more replicate, so that ranks are exact.
struct SeriesSurprise {
  Vec data;     // per candidate
  Vec highest;  // the largest of each replicate
};
SeriesSurprise surprise_of(const Vec& gains, const SeriesNull& null);
// `fit`: of the base model to the data.
SeriesNull null_of(const observations::MeasuredVesicles& data,
                   const std::vector<observations::History>& runs,
                   const std::vector<SeriesCandidate>& candidates,
                   const likelihood::EnsembleFit& fit, const likelihood::UnitPrior& unit,
                   int replicates);

}  // namespace traceraft::selection
