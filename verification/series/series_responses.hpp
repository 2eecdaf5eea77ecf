// What effects do to series, as far as another D does not do the same.
#pragma once

#include <vector>

#include "verification/series/series_gains.hpp"

namespace traceraft {

// Vectors with an entry per look. `fit`: of the base model.
class SeriesResponses {
 public:
  SeriesResponses(const std::vector<SeriesBlock>& blocks, const SeriesCurves& curves,
                  const SeriesFit& fit);

  const Vec& of(std::size_t k) const { return own_[k]; }
  // What effect k does of which no amount of effect j is capable.
  Vec beyond(std::size_t k, std::size_t j) const;
  double correlation(std::size_t j, std::size_t k) const;
  double squares(const Vec& e) const { return metric_.product(e, e); }
  double squares(std::size_t k) const { return squares(own_[k]); }
  // The quantity that shows most of it.
  Quantity telling(const Vec& e) const;

 private:
  SeriesMetric metric_;
  std::vector<Vec> own_;
};

// Numbers of effects: every two members of a class change series alike.
using SeriesClasses = std::vector<std::vector<std::size_t>>;
SeriesClasses classes_of(const SeriesResponses& responses, std::size_t effects);

}  // namespace traceraft
