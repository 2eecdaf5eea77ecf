#include <Eigen/SparseCholesky>
#include <stdexcept>

#include "kernel/effects/effects.hpp"
#include "kernel/effects/nodal_potential.hpp"
#include "kernel/effects/per_space.hpp"
#include "kernel/fem/sparse_view.hpp"

namespace traceraft::effects {
namespace {

using Factors = Eigen::SimplicialLLT<fem::EigenMatrix>;

fem::CsrMatrix screened_stiffness(const fem::SurfaceSpace& space, double kappa) {
  return fem::combine(1, fem::combine(1, space.stiffness, space.h(), space.normal_stiffness),
                      kappa * kappa, space.stabilised_mass);
}

// Worth keeping: each product with the Jacobian needs them, and conjugate gradients take some 30/h
// iterations.
std::shared_ptr<const Factors> factors_of(const fem::SurfaceSpace& space, double kappa) {
  const auto result =
      std::make_shared<const Factors>(fem::as_eigen(space, screened_stiffness(space, kappa)));
  if (result->info() != Eigen::Success)
    throw std::runtime_error("the potential of Ohta and Kawasaki cannot be factorised");
  return result;
}

// φ with (κ² − Δ_Γ) φ = c − mean(c), to roundoff. `factors`: on one rank.
Vec screened_potential(const fem::SurfaceSpace& space, double kappa, PerSpace<Factors>& factors,
                       VecView c) {
  const Vec deviation = c.array() - space.integral(c) / space.area;
  Vec load = Vec::Zero(space.nodes()), potential(space.nodes()), buffer;
  space.stabilised_mass.multiply_add(1, space.with_ghosts(deviation, buffer), load, *space.team);
  if (space.communicator->size() == 1)
    potential = factors.on(space)->solve(load);
  else if (const Status status =
               space.solve_spd(screened_stiffness(space, kappa), load, potential, 1e-13);
           !status.ok())
    throw std::runtime_error("the potential of Ohta and Kawasaki: " + status.why);
  // Its mean is 0, of which a small κ² leaves what roundoff makes of it.
  potential.array() -= space.integral(potential) / space.area;
  return potential;
}

}  // namespace

// Rafts that repel each other over distances, as charged ones do: μ = … + a φ.
// Ohta, Kawasaki, Macromolecules 19 (1986).
EffectEntry ohta_kawasaki_effect() {
  return {"ohta-kawasaki",
          "rafts that repel each other over a distance",
          "",
          {{"strength", "", 0, 0, 1e6, "a"},
           {"range", "um", 5, 1e-3, 1e6, "1/kappa, the screening length"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "rafts that stop growing",
          {"exchange"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const double kappa = 1 / p["range"];
            const auto factors = std::make_shared<PerSpace<Factors>>(
                [kappa](const fem::SurfaceSpace& space) { return factors_of(space, kappa); });
            model.effects.push_back(
                nodal_potential({"ohta-kawasaki", p["strength"], true,
                                 [kappa, factors](const fem::SurfaceSpace& space, VecView c) {
                                   return screened_potential(space, kappa, *factors, c);
                                 }}));
          }};
}

}  // namespace traceraft::effects
