#include "kernel/effects/nodal_potential.hpp"

namespace traceraft::effects {
namespace {

class NodalPotentialEffect final : public problem::Effect {
 public:
  explicit NodalPotentialEffect(NodalPotential potential) : potential_(std::move(potential)) {}

  std::string name() const override { return potential_.name; }
  bool conserves_mass() const override { return true; }
  bool dissipates_energy() const override { return true; }
  bool tangent_is_assembled() const override { return !potential_.linear; }

  // One that depends on c may be stiffer than the wells are.
  bool dissipates_explicitly() const override { return !potential_.linear; }
  void add_residual(const fem::SurfaceSpace& space, double, VecView c, VecView, VecRef,
                    VecRef residual_mu) const override {
    add_load(space, c, residual_mu);
  }
  void add_tangent(const fem::SurfaceSpace&, double, VecView, VecView,
                   linear::BlockJacobian&) const override {}
  void add_tangent_product(const fem::SurfaceSpace& space, double, VecView, VecView,
                           VecView direction_c, VecView, VecRef, VecRef product_mu) const override {
    if (potential_.linear) add_load(space, direction_c, product_mu);
  }
  double energy(const fem::SurfaceSpace& space, VecView c) const override {
    const auto owned = c.head(space.nodes());
    const double product =
        space.bilinear(space.stabilised_mass, potential_.field(space, owned), owned);
    return potential_.strength * (potential_.linear ? 0.5 : 1.0) * product;
  }

 private:
  // F2 −= strength M̃ u.
  void add_load(const fem::SurfaceSpace& space, VecView c, VecRef r) const {
    const Vec u = potential_.field(space, c.head(space.nodes()));
    Vec buffer;
    space.stabilised_mass.multiply_add(-potential_.strength, space.with_ghosts(u, buffer), r,
                                       *space.team);
  }

  NodalPotential potential_;
};

}  // namespace

problem::EffectPtr nodal_potential(NodalPotential potential) {
  return std::make_shared<NodalPotentialEffect>(std::move(potential));
}

}  // namespace traceraft::effects
