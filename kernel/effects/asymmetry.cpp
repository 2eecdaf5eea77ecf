#include "kernel/effects/effects.hpp"
#include "kernel/effects/local_density.hpp"

namespace traceraft::effects {

// Wells of different curvature: f0 + a c² (1 − c)² (2c − 1), which leaves the wells where they are.
// Outside of [0, 1] 2c − 1 stays ±1: going on it would outweigh f0 there, and a small raft, whose
// tension presses c beyond 1, would run away.
EffectEntry asymmetry_effect() {
  return {
      "asymmetry",
      "a free energy that is steeper on the side of the rafts",
      "a free energy that is steeper on the side of their surroundings",
      // f0 + a g = c² (1−c)² (1/4 + a (2c−1)): below 1/4 both wells stay minima.
      {{"strength", "", 0, -0.2, 0.2, "a of a c^2 (1-c)^2 (2c-1)"}},
      MassClass::conserves,
      EnergyClass::dissipates,
      "contents of the phases",
      {"line-tension"},
      [](const Parameters& p, problem::CahnHilliardModel& model) {
        const double a = p["strength"];
        model.effects.push_back(local_density(
            {"asymmetry", problem::Slot::potential, true, true, [a](const DensityPoint& at) {
               // The energy is a g with g = −s² d, s = c (1 − c), s' = 1 − 2c =: d.
               const double c = at.c, s = c * (1 - c), d = 1 - 2 * c;
               if (s >= 0)
                 return DensityValue{a * (-2 * s * d * d + 2 * s * s),
                                     a * (-2 * d * d * d + 12 * s * d), 0, -a * s * s * d};
               const double side = c > 0.5 ? a : -a;
               return DensityValue{side * 2 * s * d, side * 2 * (d * d - 2 * s), 0, side * s * s};
             }}));
      },
      true};
}

}  // namespace traceraft::effects
