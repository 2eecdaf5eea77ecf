#include "kernel/problem/initial_data.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernel/fem/density_load.hpp"

namespace traceraft::problem {

const NamedList<InitialEntry>& initial_fields() {
  static const std::vector<InitialEntry> entries = {
      bernoulli_noise(), band_limited_noise(), cap_rafts(), disc_rafts(), formula_field(),
  };
  static const NamedList<InitialEntry> list("initial field", entries);
  return list;
}

namespace {

Vec projected_load(const fem::SurfaceSpace& space, VecView load) {
  if (!std::isfinite(space.communicator->sum(load.sum())))
    throw InputError("initial: the concentration is not finite everywhere on the surface");
  Vec projected(space.nodes());
  const Status status = space.solve_mass(load, projected);
  if (!status.ok()) throw InputError("initial: " + status.why);
  return projected;
}

// The first of the points, over all ranks, where a concentration is not finite.
template <class Concentration>
void require_finite(const fem::SurfaceSpace& space, const Concentration& c,
                    const std::string& name) {
  std::vector<double> bad;
  fem::for_each_quadrature_point(space.surface, [&](const fem::QuadraturePoint& at) {
    if (bad.empty() && !std::isfinite(c(at.x))) bad = {at.x[0], at.x[1], at.x[2]};
  });
  for (const std::vector<double>& other : gather_everywhere(*space.communicator, bad))
    bad = std::max(bad, other);
  if (bad.empty()) return;
  std::ostringstream text;
  text.precision(3);
  text << "initial '" << name << "': it is not finite at (" << bad[0] << ", " << bad[1] << ", "
       << bad[2] << "), a point of the surface";
  throw InputError(text.str());
}

Vec projected_concentration(const fem::SurfaceSpace& space, const InitialEntry& entry,
                            const InitialRequest& request, const Parameters& parameters) {
  const auto at_surface = [&, concentration =
                                  entry.concentration(request, parameters)](const Point& x) {
    return concentration(request.surface ? mesh::lifted(*request.surface, x, space.h()) : x);
  };
  Vec load = Vec::Zero(space.nodes());
  fem::add_density_load(
      space, 1, [&](const fem::QuadraturePoint& at) { return at_surface(at.x); }, load);
  if (!std::isfinite(space.communicator->sum(load.sum())))
    require_finite(space, at_surface, entry.name);
  return projected_load(space, load);
}

}  // namespace

Vec project(const fem::SurfaceSpace& space, VecView nodal) {
  Vec load(space.nodes()), buffer;
  space.mass.multiply(space.with_ghosts(nodal, buffer), load, *space.team);
  return projected_load(space, load);
}

Vec make_initial_field(const std::string& specification, const fem::SurfaceSpace& space,
                       const InitialRequest& request) {
  const NamedArguments parts = split_named_arguments(specification);
  const InitialEntry& entry = initial_fields().find(parts.name);
  const Parameters parameters =
      parse_parameters("initial '" + entry.name + "'", parts.arguments, entry.parameters);
  return entry.nodal ? project(space, entry.nodal(space, request, parameters))
                     : projected_concentration(space, entry, request, parameters);
}

InitialEntry formula_field() {
  return {"formula",
          "a formula for c(x, y, z), with coordinates in units of R",
          {},
          {},
          [](const InitialRequest& request, const Parameters&) {
            if (!request.formula)
              throw InputError("initial 'formula': a formula is needed, as in \"0.5+0.1*z\"");
            return request.formula;
          }};
}

std::function<double(const Point&)> profile_around(const std::vector<CapRaft>& caps,
                                                   const physics::DoubleWell& well,
                                                   double epsilon) {
  std::vector<Point> axis;
  for (const CapRaft& cap : caps) axis.push_back(cap.direction.stableNormalized());
  return [caps, axis, well, epsilon](const Point& x) {
    constexpr double kRoundoff = 1e-7;
    const double radius = x.norm();
    double outside = 1e300;  // arc length to the nearest raft, negative inside
    for (std::size_t k = 0; k < caps.size(); ++k) {
      // A chord is shorter than its arc: rafts that are too far need no arctangent.
      const double chord = std::sqrt(std::max(0.0, 2 - 2 * axis[k].dot(x) / radius));
      if (chord - caps[k].angle > outside + kRoundoff) continue;
      const double angle = std::atan2(axis[k].cross(x).norm(), axis[k].dot(x));
      outside = std::min(outside, angle - caps[k].angle);
    }
    return well.profile(outside, epsilon);
  };
}

InitialEntry cap_rafts() {
  return {"caps",
          "rafts that are spherical caps, with equilibrium profiles",
          {},
          {},
          [](const InitialRequest& request, const Parameters&) {
            if (request.caps.empty())
              throw InputError(
                  "initial 'caps': a direction and an angle for each raft are needed, as in \"0 0 "
                  "1 40; 1 0 0 25\"");
            return profile_around(request.caps, request.well, request.epsilon);
          }};
}

}  // namespace traceraft::problem
