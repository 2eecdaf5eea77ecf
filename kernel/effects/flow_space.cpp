#include "kernel/effects/flow_space.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"

namespace traceraft::effects {

PerSpace<FlowSpace>::Compute flow_space(int degree) {
  return [degree](const fem::SurfaceSpace& space) {
    std::vector<Point> nodes;
    for (int i = 0; i < space.nodes(); ++i) nodes.push_back(space.mesh.position(i));
    return std::make_shared<const FlowSpace>(
        FlowSpace{flow::element_curls(space), {nodes, degree, space.team, space.communicator}});
  };
}

void require_sphere(const fem::SurfaceSpace& space) {
  double off = 0;
  for (const Point& x : space.surface.position) off = std::max(off, std::fabs(x.norm() - 1));
  if (space.communicator->max(off) > space.h() * space.h())
    throw InputError("effect flow: it is made for the sphere, and this surface is another");
}

}  // namespace traceraft::effects
