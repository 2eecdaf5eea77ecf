// Brownian flow of a membrane: the velocity that thermal forces give it.
#pragma once

#include <cstdint>

#include "kernel/effects/flow_space.hpp"
#include "kernel/flow/fluid_membrane.hpp"
#include "kernel/problem/effect.hpp"

namespace traceraft::effects {

// ∂c/∂t + u·∇c = … with u = n × ∇ψ and ψ a sum of harmonics with the covariance 2Θ F⁻¹/τ of the
// friction F: in many times τ, the hold, rafts move as fluctuation and dissipation say.
// Draws are made at multiples of τ, and ψ is linear between them: integrators see a continuous
// function, and its limit of small τ is that of Stratonovich, as of a velocity that has a memory. A
// draw is a function of the seed, the degree, the order and the number of its hold. It depends
// neither on the mesh nor on the number of ranks, nor on a sphere on the highest degree.
class BrownianFlow final : public problem::RandomEffect {
 public:
  BrownianFlow(const flow::FluidMembrane& membrane, double epsilon, double hold,
               std::uint64_t seed);
  ~BrownianFlow() override;

  std::string name() const override { return "flow"; }
  bool conserves_mass() const override { return true; }
  bool dissipates_energy() const override { return false; }
  double longest_step() const override { return 0.5 * hold_; }
  void require_surface(const fem::SurfaceSpace& space) const override { (void)streams_.on(space); }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                    VecRef residual_c, VecRef residual_mu) const override;
  void add_tangent(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                   linear::BlockJacobian& J) const override;
  void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                           VecView direction_c, VecView direction_mu, VecRef product_c,
                           VecRef product_mu) const override;

  // Each harmonic of ψ is one.
  Eigen::MatrixXd noises(const fem::SurfaceSpace& space, VecView c) const override;

  // The coefficients of ψ that were drawn at so many holds.
  Vec draw(const fem::SurfaceSpace& space, double number) const;

 private:
  class Streams;  // on one space

  flow::FluidMembrane membrane_;
  int degree_;  // the highest, on a sphere
  double hold_;
  std::uint64_t seed_;
  mutable PerSpace<Streams> streams_;
};

}  // namespace traceraft::effects
