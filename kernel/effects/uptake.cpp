#include "kernel/effects/effects.hpp"
#include "kernel/effects/local_density.hpp"

namespace traceraft::effects {

// Raft lipids that come in where there is no raft: ċ = … + s (1 − c).
EffectEntry uptake_effect() {
  return {"uptake",
          "raft lipids taken up outside rafts",
          "raft lipids lost outside rafts",
          {{"rate", "1/s", 0, -1e12, 1e12, "s; negative: a loss"}},
          MassClass::drifts,
          EnergyClass::active,
          "drift of the raft fraction",
          {"cooling"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const double s = p["rate"];
            model.effects.push_back(local_density(
                {"uptake", problem::Slot::source, false, false, [s](const DensityPoint& at) {
                   return DensityValue{-s * (1 - at.c), s};
                 }}));
          },
          true,
          0,
          1,
          {},
          [](const Parameters& p, discs::DiscModel& model) { model.uptake = p["rate"]; }};
}

}  // namespace traceraft::effects
