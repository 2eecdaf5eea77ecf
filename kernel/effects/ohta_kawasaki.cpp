#include <Eigen/SparseCholesky>
#include <map>
#include <mutex>
#include <stdexcept>

#include "kernel/effects/effects.hpp"
#include "kernel/effects/nodal_potential.hpp"
#include "kernel/fem/sparse_view.hpp"

namespace traceraft {
namespace {

// φ with (κ² − Δ_Γ) φ = c − mean(c), to roundoff.
class ScreenedPotential {
 public:
  explicit ScreenedPotential(double kappa) : kappa_(kappa) {}

  Vec of(const SurfaceSpace& space, ConstVec c) {
    const Vec deviation = c.array() - space.integral(c) / space.area;
    Vec load = Vec::Zero(space.nodes()), potential(space.nodes()), buffer;
    space.stabilised_mass.multiply_add(1, space.with_ghosts(deviation, buffer), load, *space.team);
    if (space.communicator->size() == 1)
      potential = factors(space)->solve(load);
    else if (const Status status = space.solve_spd(matrix(space), load, potential, 1e-13);
             !status.ok())
      throw std::runtime_error("the potential of Ohta and Kawasaki: " + status.why);
    // Its mean is 0, of which a small κ² leaves what roundoff makes of it.
    potential.array() -= space.integral(potential) / space.area;
    return potential;
  }

 private:
  using Factors = Eigen::SimplicialLLT<EigenMatrix>;

  CsrMatrix matrix(const SurfaceSpace& space) const {
    return combine(1, combine(1, space.stiffness, space.h(), space.normal), kappa_ * kappa_,
                   space.stabilised_mass);
  }
  // Kept, as each product with the Jacobian needs them and conjugate gradients take some 30/h
  // iterations. Spaces are told apart by their patterns, which they do not share.
  std::shared_ptr<const Factors> factors(const SurfaceSpace& space) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (const auto known = factors_.find(space.pattern); known != factors_.end())
      return known->second;
    for (auto it = factors_.begin(); it != factors_.end();)
      it = it->first.expired() ? factors_.erase(it) : std::next(it);
    const auto computed = std::make_shared<const Factors>(as_eigen(space, matrix(space)));
    if (computed->info() != Eigen::Success)
      throw std::runtime_error("the potential of Ohta and Kawasaki cannot be factorised");
    return factors_[space.pattern] = computed;
  }

  const double kappa_;
  std::mutex mutex_;
  std::map<std::weak_ptr<const SparsityPattern>, std::shared_ptr<const Factors>, std::owner_less<>>
      factors_;
};

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
          [](const Parameters& p, CahnHilliardModel& model) {
            const auto potential = std::make_shared<ScreenedPotential>(1 / p["range"]);
            model.effects.push_back(
                nodal_potential({"ohta-kawasaki", p["strength"], true,
                                 [potential](const SurfaceSpace& space, ConstVec c) {
                                   return potential->of(space, c);
                                 }}));
          }};
}

}  // namespace traceraft
