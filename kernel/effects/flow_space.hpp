// The transport of a surface, the harmonics at its nodes and its friction, for flow.
#pragma once

#include "kernel/effects/per_space.hpp"
#include "kernel/flow/friction.hpp"
#include "kernel/flow/transport.hpp"

namespace traceraft::effects {

struct FlowSpace {
  std::vector<flow::ElementCurl> curls;
  std::shared_ptr<const flow::Friction> friction;
  flow::HarmonicTransform harmonics;  // at the nodes of this rank
};

// Harmonics go up to `degree`, or as far as the friction of the surface is known. Throws InputError
// if the surface is not like a sphere.
FlowSpace make_flow_space(const fem::SurfaceSpace& space, const flow::FluidMembrane& membrane,
                          int degree);

}  // namespace traceraft::effects
