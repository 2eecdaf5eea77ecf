// The only door between a model and a time integrator: F(t, y, ẏ) = 0.
#pragma once

#include <limits>

#include "kernel/core/status.hpp"
#include "kernel/core/types.hpp"
#include "kernel/linear/block_jacobian.hpp"

namespace traceraft::problem {

// A semi-explicit DAE of index 1. y = (c, μ): the first half is differential, the second algebraic;
// both hold this rank's owned entries. Functions of the state are collective, and what they return
// as a status or a number is the same on all ranks.
//
// What an implicit method needs is F and, for its Newton matrix, J = ∂F/∂y + σ ∂F/∂ẏ: with
// ẏ ≈ σ y + (known), dF(t, y, ẏ(y))/dy = J. Every method brings its own shift σ (1/Δt for
// backward Euler, IDA's c_j, …). All methods are const: an integrator owns the state.
class DaeProblem {
 public:
  virtual ~DaeProblem() = default;

  virtual int block_size() const = 0;  // n, so that y has 2n entries
  int size() const { return 2 * block_size(); }

  // r = F(t, y, ẏ). retry: y is outside the domain of the model or not finite.
  virtual Status residual(double t, VecView y, VecView ydot, VecRef r) const = 0;

  // Assembles J at (t, y, ẏ) with the shift σ and the given tangent.
  virtual Status jacobian(double t, VecView y, VecView ydot, double shift, linear::Tangent tangent,
                          linear::BlockJacobian& J) const = 0;

  // product = J v without assembling J.
  virtual Status jacobian_product(double t, VecView y, VecView ydot, double shift,
                                  linear::Tangent tangent, VecView v, VecRef product) const = 0;

  // An empty Jacobian with the pattern of this problem.
  virtual linear::BlockJacobian make_jacobian() const = 0;

  // Given c in the first half of y, sets μ so that the algebraic equations hold and ẏ so that
  // F(t, y, ẏ) = 0 (the second half of ẏ is zero: it does not appear).
  virtual Status consistent_initial_state(double t, VecRef y, VecRef ydot) const = 0;

  // Norm of the differential part in L²(Γ_h): independent of the mesh.
  virtual double norm(VecView y) const = 0;

  // Norm of one half of a state vector, c or μ, that sees every mode of it (in L²(Γ_h) a function
  // that vanishes on the surface has none) and does not depend on the mesh.
  virtual double field_norm(VecView half) const = 0;

  // A linear functional of y that every solution keeps (the mass), and whether the model keeps it.
  virtual double mass(VecView y) const = 0;
  virtual bool conserves_mass() const = 0;

  // A functional that does not grow along solutions, and whether the model promises that.
  virtual double energy(VecView y) const = 0;
  virtual bool dissipates_energy() const = 0;
  // Whether steps of first order with the stabilised tangent let it fall, too.
  virtual bool dissipates_in_stabilised_steps() const { return dissipates_energy(); }
  // Are steps stable whose stabilised tangent stands at an extrapolated state?
  virtual bool may_be_extrapolated() const { return true; }
  // Integrators that take longer steps would not see what it does in time.
  virtual double longest_step() const { return std::numeric_limits<double>::infinity(); }
  // The size of its terms, which cancel near equilibrium: its roundoff is relative to that.
  virtual double energy_scale() const = 0;

  // Whom the state is shared with.
  virtual const Communicator& ranks() const = 0;
};

}  // namespace traceraft::problem
