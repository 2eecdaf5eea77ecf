// How strong hidden effects have to be to make the gap that is asked for.
#pragma once

#include "kernel/effects/effects.hpp"
#include "verification/explain/blind_request.hpp"

namespace traceraft {

// Effects that can be hidden: those that a sphere shows.
std::vector<std::string> effects_to_hide();

// The request's effects with the strengths at which they make its gap. Throws std::runtime_error if
// a simulation fails, InputError for an effect that cannot be hidden.
std::vector<EffectTerm> size_effects(const BlindRequest& request);

}  // namespace traceraft
