#include <stdexcept>

#include "kernel/effects/effects.hpp"
#include "kernel/effects/nodal_potential.hpp"

namespace traceraft {
namespace {

// φ with (κ² − Δ_Γ) φ = c − mean(c), by conjugate gradients to roundoff.
Vec screened_potential(const SurfaceSpace& space, double kappa, ConstVec c) {
  const CsrMatrix matrix = combine(1, combine(1, space.stiffness, space.h(), space.normal),
                                   kappa * kappa, space.stabilised_mass);
  const Vec deviation = c.array() - space.integral(c) / space.area;
  Vec load = Vec::Zero(space.nodes()), potential(space.nodes()), buffer;
  space.stabilised_mass.multiply_add(1, space.with_ghosts(deviation, buffer), load, *space.team);
  if (const Status status = space.solve_spd(matrix, load, potential, 1e-13); !status.ok())
    throw std::runtime_error("the potential of Ohta and Kawasaki: " + status.why);
  return potential;
}

}  // namespace

// Rafts that repel each other over distances, as charged ones do: μ = … + a φ.
// Ohta, Kawasaki, Macromolecules 19 (1986).
EffectEntry ohta_kawasaki_effect() {
  return {
      "ohta-kawasaki",
      "rafts that repel each other over a distance",
      "",
      {{"strength", "", 0, 0, 1e6, "a"},
       {"range", "um", 5, 1e-3, 1e6, "1/kappa, the screening length"}},
      MassClass::conserves,
      EnergyClass::dissipates,
      "rafts that stop growing",
      {"exchange"},
      [](const Parameters& p, CahnHilliardModel& model) {
        const double kappa = 1 / p["range"];
        model.effects.push_back(nodal_potential(
            {"ohta-kawasaki", p["strength"], true, [kappa](const SurfaceSpace& space, ConstVec c) {
               return screened_potential(space, kappa, c);
             }}));
      }};
}

}  // namespace traceraft
