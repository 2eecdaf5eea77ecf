// The transport of a surface and the harmonics at its nodes, for flow.
#pragma once

#include "kernel/effects/per_space.hpp"
#include "kernel/flow/harmonic_transform.hpp"
#include "kernel/flow/transport.hpp"

namespace traceraft::effects {

struct FlowSpace {
  std::vector<flow::ElementCurl> curls;
  flow::HarmonicTransform harmonics;  // at the nodes of this rank
};

PerSpace<FlowSpace>::Compute flow_space(int degree);

// Throws InputError if the surface is no unit sphere.
void require_sphere(const fem::SurfaceSpace& space);

}  // namespace traceraft::effects
