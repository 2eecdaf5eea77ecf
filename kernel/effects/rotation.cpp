#include "kernel/effects/advection.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft {

// A vesicle that turns under the microscope: u = ω × x.
EffectEntry rotation_effect() {
  return {"rotation",
          "a vesicle that turns",
          "a vesicle that turns, the other way round",
          {{"rate", "1/s", 0, -1e9, 1e9, "angular velocity"},
           {"x", "", 0, -1, 1, "of the axis"},
           {"y", "", 0, -1, 1, "of the axis"},
           {"z", "", 1, -1, 1, "of the axis"}},
          MassClass::conserves,
          EnergyClass::neutral,
          "place of rafts only",
          {},
          [](const Parameters& p, CahnHilliardModel& model) {
            const Point axis(p["x"], p["y"], p["z"]);
            if (axis.norm() == 0) throw InputError("effect rotation: the axis x, y, z is zero");
            const Point omega = p["rate"] * axis.normalized();
            model.effects.push_back(advection(
                "rotation", [omega](const Point& x, double) -> Point { return omega.cross(x); }));
          }};
}

}  // namespace traceraft
