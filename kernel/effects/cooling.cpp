#include <cmath>

#include "kernel/effects/effects.hpp"
#include "kernel/effects/local_density.hpp"
#include "kernel/effects/mobility_flux.hpp"

namespace traceraft::effects {

// A temperature that falls steadily, T(t) = T(0) − rate · t. Rafts become richer and their
// surroundings poorer in raft lipids: in units where the phases stay at 0 and 1, a lipid between
// them gains c where there is no raft and loses it in rafts,
//   ċ = … + rate (g_out (1 − c) − g_in c),
// which conserves lipids, but not ∫c. Diffusion slows down by exp(−activation · rate · t).
EffectEntry cooling_effect() {
  return {"cooling",
          "a falling temperature, so that the phases differ more and diffusion slows down",
          "a rising temperature, so that the phases differ less and diffusion speeds up",
          {{"rate", "K/s", 0, -1e9, 1e9, "fall of the temperature; negative: a rise"},
           {"out", "1/K", 0.02, 0, 1, "gain of c outside rafts"},
           {"in", "1/K", 0.005, 0, 1, "loss of c in rafts"},
           {"activation", "1/K", 0.04, 0, 1, "relative loss of D"}},
          MassClass::drifts,
          EnergyClass::active,
          "drift of the raft fraction, and a change of D",
          {"uptake"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const double out = p["rate"] * p["out"], in = p["rate"] * p["in"];
            model.effects.push_back(local_density(
                {"cooling", problem::Slot::source, false, false, [out, in](const DensityPoint& at) {
                   return DensityValue{in * at.c - out * (1 - at.c), in + out};
                 }}));
            const double slowing = p["rate"] * p["activation"];
            model.effects.push_back(mobility_flux(
                "cooling", model.mobility, [slowing](double t) { return std::expm1(-slowing * t); },
                true));
            model.diffusion_ratio = [slowing](double t) { return std::exp(-slowing * t); };
          },
          true,
          4};
}

}  // namespace traceraft::effects
