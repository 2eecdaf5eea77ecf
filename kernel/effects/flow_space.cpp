#include "kernel/effects/flow_space.hpp"

#include "kernel/core/error.hpp"

namespace traceraft::effects {

FlowSpace make_flow_space(const fem::SurfaceSpace& space, const flow::FluidMembrane& membrane,
                          int degree) try {
  const geometry::StarSurface surface(space.level_set);
  std::shared_ptr<const flow::Friction> friction = flow::make_friction(surface, membrane, degree);
  std::vector<Point> rays;
  for (int i = 0; i < space.nodes(); ++i) rays.push_back(space.mesh.position(i) - surface.centre());
  const int highest = friction->degree();
  return {flow::element_curls(space),
          std::move(friction),
          {rays, highest, space.team, space.communicator}};
} catch (const InputError& error) {
  throw InputError(std::string("effect flow: it needs a surface like a sphere, and ") +
                   error.what());
}

}  // namespace traceraft::effects
