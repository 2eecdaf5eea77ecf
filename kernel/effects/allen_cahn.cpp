#include "kernel/effects/effects.hpp"
#include "kernel/effects/local_density.hpp"

namespace traceraft::effects {

// Lipids that turn into each other, downhill in energy: ċ = … − L μ.
EffectEntry allen_cahn_effect() {
  return {"allen-cahn",
          "conversion of lipids into each other, driven by the chemical potential",
          "",
          {{"rate", "1/s", 0, 0, 1e12, "L"}},
          MassClass::drifts,
          EnergyClass::dissipates,
          "small rafts vanish faster",
          {"uptake"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const double L = p["rate"];
            model.effects.push_back(local_density(
                {"allen-cahn", problem::Slot::source, false, true, [L](const DensityPoint& at) {
                   return DensityValue{L * at.mu, 0, L};
                 }}));
          }};
}

}  // namespace traceraft::effects
