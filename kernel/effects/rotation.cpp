#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernel/effects/advection.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::effects {
namespace {

// How far the surface is from one that turns into itself: of its first and second moments, what a
// quarter of a turn changes.
double asymmetry_around(const Point& axis, const fem::SurfaceSpace& space) {
  Eigen::MatrixX3d x(space.nodes(), 3);
  for (int i = 0; i < space.nodes(); ++i) x.row(i) = space.mesh.position(i);
  Point first;
  Eigen::Matrix3d second;
  for (int i = 0; i < 3; ++i) {
    first[i] = space.integral(x.col(i));
    for (int j = 0; j < 3; ++j) second(i, j) = space.inner(x.col(i), x.col(j));
  }
  const Eigen::Matrix3d quarter = Eigen::AngleAxisd(kPi / 2, axis).toRotationMatrix();
  return std::max((quarter * first - first).norm() / std::sqrt(space.area * second.trace()),
                  (quarter * second * quarter.transpose() - second).norm() / second.norm());
}

void require_revolution(const Point& axis, const fem::SurfaceSpace& space) {
  constexpr double kOfTheMesh = 0.01;
  if (const double part = asymmetry_around(axis, space); part > kOfTheMesh)
    throw InputError(
        "effect rotation: the surface is not symmetric around the axis x, y, z; its moments differ "
        "by " +
        format_number(std::round(1000 * part) / 10) +
        " % after a quarter of a turn (allowed: 1 %)");
}

}  // namespace

// A vesicle that rotates under the microscope: u = ω × x. On another body than one of revolution
// this would not lie in the surface, and what does of it would compress the membrane.
EffectEntry rotation_effect() {
  return {"rotation",
          "a rotating vesicle",
          "a vesicle that rotates the other way round",
          {{"rate", "1/s", 0, -1e9, 1e9, "angular velocity"},
           {"x", "", 0, -1, 1, "component of the axis"},
           {"y", "", 0, -1, 1, "component of the axis"},
           {"z", "", 1, -1, 1, "component of the axis"}},
          MassClass::conserves,
          EnergyClass::neutral,
          "place of rafts only",
          {},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const Point axis(p["x"], p["y"], p["z"]);
            if (axis.isZero(0)) throw InputError("effect rotation: the axis x, y, z is zero");
            const Point unit = axis.stableNormalized(), omega = p["rate"] * unit;
            model.effects.push_back(advection(
                "rotation", [omega](const Point& x, double) -> Point { return omega.cross(x); },
                [unit](const fem::SurfaceSpace& space) { require_revolution(unit, space); }));
          }};
}

}  // namespace traceraft::effects
