// The found model, held against the data once more: on another mesh and by another integrator.
#pragma once

#include "verification/selection/search/search.hpp"

namespace traceraft::selection {

// Is there anything to look at again: effects that were found, or a gap that nothing explains?
bool is_to_run_again(const Explanation& found);

// Nothing is left of a finding that this refutes: it is a gap that nothing explains then, or, where
// that is not significant, too little to say what. A gap that the search could not explain, and
// that is not there on the other mesh, is one of the mesh: what was found without it stands.
void run_again(const std::vector<assimilation::FieldSeries>& series, const ExplainRequest& request,
               Explanation& found);

// How two models foretell the same measurements: Rerun's gain and shortfall, and the gaps.
// `mesh_error`: of forecasts, as in Screening.
Rerun compare_forecasts(const assimilation::FilterResult& base,
                        const assimilation::FilterResult& found, double mesh_error);

// The gaps of a model that has these effects already, and what is to be expected of them with this
// noise (none: as single fields tell it). Throws std::runtime_error if it cannot be advanced.
struct ModelGaps {
  assimilation::Gaps gap, expected;
};
ModelGaps gaps_of_model(const std::vector<assimilation::FieldSeries>& series,
                        const ExplainRequest& request, double diffusion_ratio,
                        const std::vector<effects::EffectTerm>& effects,
                        const std::optional<assimilation::NoiseModel>& noise = {});

}  // namespace traceraft::selection
