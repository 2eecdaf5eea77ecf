#include "kernel/effects/effects.hpp"
#include "kernel/effects/local_density.hpp"

namespace traceraft::effects {

// Rafts that are heavier than what they float in: μ = … + λ z.
EffectEntry gravity_effect() {
  return {"gravity",
          "a potential that grows with height, so that rafts sink",
          "a potential that falls with height, so that rafts rise",
          {{"strength", "", 0, -10, 10, "lambda of lambda z/R"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "rafts drift to a pole",
          {"curvature"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const double lambda = p["strength"];
            model.effects.push_back(local_density(
                {"gravity", problem::Slot::potential, true, true, [lambda](const DensityPoint& at) {
                   return DensityValue{lambda * at.x[2], 0, 0, lambda * at.x[2] * at.c};
                 }}));
          }};
}

}  // namespace traceraft::effects
