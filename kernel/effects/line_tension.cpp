#include <cmath>

#include "kernel/effects/effects.hpp"

namespace traceraft::effects {

// ε² (1 + d): boundaries cost √(1 + d) times as much, and are as much wider.
EffectEntry line_tension_effect() {
  return {"line-tension",
          "boundaries that cost more than the model says",
          "boundaries that cost less than the model says",
          {{"excess", "", 0, -0.9, 10, "d of epsilon^2 (1 + d)"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "level of the perimeter",
          {"asymmetry"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            model.epsilon *= std::sqrt(1 + p["excess"]);
          }};
}

}  // namespace traceraft::effects
