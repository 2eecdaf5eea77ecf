// Flow of a membrane that the line tension of rafts drives.
#pragma once

#include "kernel/effects/flow_space.hpp"
#include "kernel/flow/fluid_membrane.hpp"
#include "kernel/problem/effect.hpp"

namespace traceraft::effects {

// Boundaries pull the membrane, a fluid of two dimensions, and it carries them along:
//   ∂c/∂t + u·∇c = …,   u = n × ∇ψ,   friction(ψ) = −A n·(∇μ × ∇c).
// In weak form the transport is −T(c, ψ, v) in F1 and the force A T(c, μ, ·), with one trilinear
// form T that is antisymmetric in its last two: dE/dt gains −friction(ψ, ψ)/A exactly.
class CapillaryFlow final : public problem::Effect {
 public:
  CapillaryFlow(const flow::FluidMembrane& membrane, double epsilon);

  std::string name() const override { return "flow"; }
  bool conserves_mass() const override { return true; }
  bool dissipates_energy() const override { return true; }
  // Short waves grow then, at a rate of about A.
  bool may_be_extrapolated() const override { return false; }
  bool tangent_is_assembled() const override { return false; }
  void require_surface(const fem::SurfaceSpace& space) const override {
    (void)operators_.on(space);
  }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                    VecRef residual_c, VecRef residual_mu) const override;
  // Flow with c held is one more mobility, which couples distant points: ċ = −(K_M + T G Tᵀ) μ.
  void add_stabilised_product(const fem::SurfaceSpace& space, double t, VecView c,
                              VecView direction_mu, VecRef product_c) const override;
  void add_tangent(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                   linear::BlockJacobian& J) const override;
  void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                           VecView direction_c, VecView direction_mu, VecRef product_c,
                           VecRef product_mu) const override;

  // Friction takes as much of the energy per time: ψᵀ F ψ/A. Collective.
  double dissipation(const fem::SurfaceSpace& space, VecView c, VecView mu) const;

 private:
  Vec stream(const fem::SurfaceSpace& space, VecView c, VecView mu) const;  // coefficients of ψ
  Vec stream_at_nodes(const fem::SurfaceSpace& space, VecView c, VecView mu) const;

  double capillary_;
  mutable PerSpace<FlowSpace> operators_;
};

}  // namespace traceraft::effects
