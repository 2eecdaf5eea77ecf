// Synthetic measurements with a hidden effect, or none, from a simulation that shares neither mesh
// nor resolution nor integrator with the analysis.
#pragma once

#include "kernel/effects/effects.hpp"
#include "verification/assimilation/fields/field_series.hpp"
#include "verification/selection/blind/blind_request.hpp"

namespace traceraft::selection {

struct BlindCase {
  std::vector<assimilation::FieldSeries> vesicles;
  std::vector<effects::EffectTerm> truth;  // in units of R and R²/D of the truth
  double noise;                            // standard deviation of the values
};

// Throws std::runtime_error if a simulation fails, InputError for an effect that cannot be hidden.
BlindCase draw_blind_case(const BlindRequest& request);

}  // namespace traceraft::selection
