// What was found, held against the data once more: on another mesh and by another integrator.
#pragma once

#include "verification/explain/explanation.hpp"

namespace traceraft {

Rerun run_again(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                const Explanation& found);

// The gaps of a model that has these effects already, in units of c, and what is to be expected of
// them, in units of the noise. Throws std::runtime_error if it cannot be advanced.
struct ModelGaps {
  Gaps gap, expected;
};
ModelGaps gaps_of_model(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                        double pace, const std::vector<EffectTerm>& effects);

}  // namespace traceraft
