// Lipids carried along by a flow in the membrane.
#pragma once

#include <functional>

#include "kernel/problem/effect.hpp"

namespace traceraft::effects {

// A velocity (R per R²/D) at a place and time; what is not tangential does not count.
using Velocity = std::function<Point(const Point&, double)>;

// ∂c/∂t + div(c u) = …, that is −∫ c u·∇_Γ v in F1: conserves ∫c for any u. With an incompressible
// u it leaves the energy alone but for the error of the mesh. `require_surface` is called with the
// space of a run and throws InputError if the flow is none of this surface.
problem::EffectPtr advection(std::string name, Velocity velocity,
                             std::function<void(const fem::SurfaceSpace&)> require_surface = {});

}  // namespace traceraft::effects
