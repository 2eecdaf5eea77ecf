#include "kernel/effects/effects.hpp"
#include "kernel/effects/local_density.hpp"

namespace traceraft::effects {

// Lipids that go to and fro between the membrane and a reservoir of composition c*:
// ċ = … − k (c − c*). Foret 2005; Gómez, Sagués, Reigada 2008.
EffectEntry exchange_effect() {
  return {"exchange",
          "exchange of lipids with a reservoir, so that c relaxes to a target",
          "",
          {{"rate", "1/s", 0, 0, 1e12, "k"}, {"target", "", 0.5, 0, 1, "c of the reservoir"}},
          MassClass::drifts,
          EnergyClass::active,
          "drift of the raft fraction, rafts that stop growing",
          {"ohta-kawasaki", "uptake"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const double k = p["rate"], target = p["target"];
            model.effects.push_back(local_density({"exchange", problem::Slot::source, false, false,
                                                   [k, target](const DensityPoint& at) {
                                                     return DensityValue{k * (at.c - target), k};
                                                   }}));
          }};
}

}  // namespace traceraft::effects
