// The responses of series to effects, as far as another D does not do the same.
#pragma once

#include <vector>

#include "verification/selection/series/series_gains.hpp"
#include "verification/selection/series/series_need.hpp"

namespace traceraft::selection {

// The response of a series to an effect.
struct SeriesResponse {
  Vec looks;        // an entry per look
  double unit = 0;  // of what was known of D before: one look more, in its standard deviations
};
SeriesResponse operator*(double factor, const SeriesResponse& response);

// `fit`: of the base model; `unit`: what was known of D before.
class SeriesResponses {
 public:
  // `levels`: of each candidate, the number of the level whose response is meant.
  SeriesResponses(const std::vector<likelihood::ObservedSeries>& blocks, const SeriesCurves& curves,
                  const std::vector<std::size_t>& levels, const likelihood::EnsembleFit& fit,
                  const likelihood::UnitPrior& unit);

  const SeriesResponse& of(std::size_t k) const { return own_[k]; }
  // The part of effect k's response of which no amount of effect j is capable.
  SeriesResponse beyond(std::size_t k, std::size_t j) const;
  double correlation(std::size_t j, std::size_t k) const;
  // The products of e over the looks alone, without what was known of D before.
  SeriesProducts products(const SeriesResponse& e) const;
  // The quantity that shows most of it.
  observations::Quantity telling(const SeriesResponse& e) const;

 private:
  double product(const SeriesResponse& a, const SeriesResponse& b) const;

  likelihood::ObservationMetric metric_;
  SeriesResponse by_unit_;  // what another D does
  std::vector<SeriesResponse> own_;
};

// Numbers of effects: every two members of a class change series alike.
using SeriesClasses = std::vector<std::vector<std::size_t>>;
SeriesClasses classes_of(const SeriesResponses& responses, std::size_t effects);

}  // namespace traceraft::selection
