#include "kernel/problem/initial_data.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft {

const NamedList<InitialEntry>& initial_fields() {
  static const std::vector<InitialEntry> entries = {
      bernoulli_noise(),
      band_limited_noise(),
      cap_rafts(),
      formula_field(),
  };
  static const NamedList<InitialEntry> list("initial field", entries);
  return list;
}

Vec project(const SurfaceSpace& space, ConstVec nodal) {
  if (!std::isfinite(space.communicator->sum(nodal.sum())))
    throw InputError("initial: the concentration is not finite everywhere near the surface");
  Vec load(space.nodes()), buffer, projected(space.nodes());
  space.mass.multiply(space.with_ghosts(nodal, buffer), load, *space.team);
  const Status status = space.solve_mass(load, projected);
  if (!status.ok()) throw InputError("initial: " + status.why);
  return projected;
}

Vec make_initial_field(const std::string& specification, const SurfaceSpace& space,
                       const InitialRequest& request) {
  const NamedArguments parts = split_named_arguments(specification);
  const InitialEntry& entry = initial_fields().find(parts.name);
  const Parameters parameters =
      parse_parameters("initial '" + entry.name + "'", parts.arguments, entry.parameters);
  return project(space, entry.make(space, request, parameters));
}

InitialEntry formula_field() {
  return {"formula",
          "c(x, y, z) from --initial-formula, coordinates in units of R",
          {},
          [](const SurfaceSpace& space, const InitialRequest& request, const Parameters&) {
            if (!request.formula)
              throw InputError(
                  "initial 'formula': needs --initial-formula, as in "
                  "--initial-formula \"0.5+0.1*z\"");
            Vec c(space.nodes());
            for (int i = 0; i < space.nodes(); ++i) c[i] = request.formula(space.mesh.position(i));
            return c;
          }};
}

InitialEntry cap_rafts() {
  return {"caps",
          "spherical-cap rafts from --initial-caps, with equilibrium profiles",
          {},
          [](const SurfaceSpace& space, const InitialRequest& request, const Parameters&) {
            if (request.caps.empty())
              throw InputError(
                  "initial 'caps': needs --initial-caps, as in "
                  "--initial-caps \"0 0 1 40; 1 0 0 25\" (direction and angle)");
            Vec c(space.nodes());
            for (int i = 0; i < space.nodes(); ++i) {
              const Point x = space.mesh.position(i);
              double outside = 1e300;  // arc length to the nearest raft, negative inside
              for (const CapRaft& cap : request.caps) {
                const Point axis = cap.direction.normalized();
                const double angle = std::atan2(axis.cross(x).norm(), axis.dot(x));
                outside = std::min(outside, angle - cap.angle);
              }
              c[i] = request.well.profile(outside, request.epsilon);
            }
            return c;
          }};
}

}  // namespace traceraft
