#include "kernel/problem/initial_data.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

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

namespace {

// Nodes lie up to a cell beside the surface, where acos(z), say, is not defined.
void require_finite_formula(const SurfaceSpace& space, const Vec& c) {
  std::vector<double> bad;  // the first place where it is not
  for (int i = 0; i < space.nodes() && bad.empty(); ++i)
    if (const Point x = space.mesh.position(i); !std::isfinite(c[i])) bad = {x[0], x[1], x[2]};
  for (const std::vector<double>& other : gather_everywhere(*space.communicator, bad))
    bad = std::max(bad, other);
  if (bad.empty()) return;
  std::ostringstream text;
  text.precision(3);
  text << "initial 'formula': --initial-formula is not finite at (" << bad[0] << ", " << bad[1]
       << ", " << bad[2]
       << "), a node of the mesh beside the surface; on a sphere write z/sqrt(x^2+y^2+z^2) for z, "
          "as in acos(z/sqrt(x^2+y^2+z^2)), and so for x and y";
  throw InputError(text.str());
}

}  // namespace

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
            require_finite_formula(space, c);
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
