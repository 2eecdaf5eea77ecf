#include "kernel/effects/effects.hpp"
#include "kernel/effects/mobility_flux.hpp"

namespace traceraft {

// Lipids that move within the phases, too, not along boundaries alone: M(c) + m0.
EffectEntry bulk_mobility_effect() {
  return {
      "bulk-mobility",
      "lipids that diffuse through the phases: a mobility everywhere",
      {{"strength", "", 0, 0, 10, "m0, in units of D"}},
      MassClass::conserves,
      EnergyClass::dissipates,
      "coarsening like t^(1/3) instead of t^(1/4)",
      {"mobility-exponent"},
      [](const Parameters& p, CahnHilliardModel& model) {
        const double m0 = p["strength"];
        model.effects.push_back(mobility_flux(
            "bulk-mobility", make_mobility("constant:value=1"), [m0](double) { return m0; }, true));
      }};
}

}  // namespace traceraft
