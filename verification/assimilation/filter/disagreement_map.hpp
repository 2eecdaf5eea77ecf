// Where on the vesicle measurements and forecasts disagree, as a picture.
#pragma once

#include <vector>

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::assimilation {

struct DisagreementMap {
  std::size_t vesicle;
  double time;
  Vec z;  // per place: means of measured minus forecast nearby, in standard deviations of noise
};

struct DisagreementMaps {
  std::vector<DisagreementMap> snapshots;
  double threshold = 0;  // |z| that noise alone surpasses anywhere on them in 1 of 20 data sets
};

// `data`: what the result is of. Means have Gaussian weights of the given length. Places near which
// nothing was measured get 0.
DisagreementMaps disagreement_maps(const FilterProblems& data, const FilterResult& result,
                                   const std::vector<Point>& places, double length);

}  // namespace traceraft::assimilation
