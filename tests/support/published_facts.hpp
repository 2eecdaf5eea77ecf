// Published facts of the membrane 3:1.
#pragma once

#include "verification/observations/published.hpp"

namespace traceraft::testing {

inline observations::PublishedFacts facts_of_3to1() {
  observations::PublishedFacts facts;
  facts.vesicles = 17;
  facts.measurements = 62;
  facts.fraction = 0.09;
  facts.fraction_sd = 0.011;
  facts.radius_min = 4;
  facts.radius_max = 8;
  facts.perimeter = {53, 21.1, -0.37, 0.15};
  facts.window = {100, 1000};
  return facts;
}

}  // namespace traceraft::testing
