// A term added to the base model.
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "kernel/fem/surface_space.hpp"
#include "kernel/linear/block_jacobian.hpp"

namespace traceraft::problem {

// Where the weak form ∫ (…) v of an effect enters:
//   F1 = M̃ċ + K_M(c) μ + ρ S μ + source + flux,   F2 = M̃μ − b(c) − ε²(K + ρ S)c − potential.
enum class Slot { source, flux, potential };

// Contract: adds its own contribution and nothing else; a pure function of (t, c, μ); the tangent
// is the exact derivative of the residual. c and μ are local fields (with ghosts).
class Effect {
 public:
  virtual ~Effect() = default;
  virtual std::string name() const = 0;
  virtual bool conserves_mass() const = 0;
  virtual bool dissipates_energy() const = 0;
  // The part that the stabilised tangent needs to be stable, with c frozen: a flux that is linear
  // in μ. Adds to J.cm and, for a direction of μ, to the product.
  virtual void add_stabilised(const fem::SurfaceSpace&, double /*t*/, VecView /*c*/,
                              linear::BlockJacobian&) const {}
  virtual void add_stabilised_product(const fem::SurfaceSpace&, double /*t*/, VecView /*c*/,
                                      VecView /*direction_mu*/, VecRef /*product_c*/) const {}
  // Is the assembled tangent all of it? Effects that couple distant points leave their part of the
  // Jacobian to add_tangent_product; with the assembled one Newton's method then converges
  // linearly.
  virtual bool tangent_is_assembled() const { return true; }
  // Does the energy fall in steps with the stabilised tangent, too, which treat the effect
  // explicitly? A potential does as the wells do, while |f0''| ≤ 2β with it.
  virtual bool dissipates_explicitly() const { return dissipates_energy(); }
  // Are they stable, too, where c and μ are extrapolated?
  virtual bool may_be_extrapolated() const { return true; }
  // Does it need tetrahedra of one size, as noise does that is drawn for each?
  virtual bool needs_equal_cells() const { return false; }
  // The longest step, as of DaeProblem.
  virtual double longest_step() const { return std::numeric_limits<double>::infinity(); }
  // Throws InputError if the effect is not made for this surface.
  virtual void require_surface(const fem::SurfaceSpace&) const {}
  // The energy that the effect adds, over all ranks; F2 is the gradient of the sum.
  virtual double energy(const fem::SurfaceSpace&, VecView /*c*/) const { return 0; }

  virtual void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                            VecRef residual_c, VecRef residual_mu) const = 0;
  virtual void add_tangent(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                           linear::BlockJacobian& J) const = 0;
  virtual void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                                   VecView direction_c, VecView direction_mu, VecRef product_c,
                                   VecRef product_mu) const = 0;
};

using EffectPtr = std::shared_ptr<const Effect>;

// An effect whose draws are, in many of them, independent white noises W_k times fields:
//   M̃ dc = … + Σ_k r_k(c) dW_k.
class RandomEffect : public Effect {
 public:
  // The r_k, nodes × their number, per square root of R²/D. Serial spaces only.
  virtual Eigen::MatrixXd noises(const fem::SurfaceSpace& space, VecView c) const = 0;
};

}  // namespace traceraft::problem
