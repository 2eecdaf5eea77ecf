// The trace finite element semi-discretisation of the surface Cahn–Hilliard equation as a DAE.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "kernel/fem/potential.hpp"
#include "kernel/physics/mobility.hpp"
#include "kernel/problem/dae_problem.hpp"
#include "kernel/problem/effect.hpp"

namespace traceraft::problem {

// Physics in units of R (length) and R²/D (time).
struct CahnHilliardModel {
  physics::MobilityPtr mobility;
  physics::DoubleWell well;
  double epsilon = 0.05;  // width of the phase boundary
  fem::PotentialRule rule = fem::PotentialRule::averaged;
  double stabilisation = 1.0;                           // ρ = stabilisation · h, of the smallest
  double mass_stabilisation = fem::kMassStabilisation;  // of the space that the problem is posed on
  std::vector<EffectPtr> effects;
  // How fast lipids are in time, over `mobility`, where an effect changes that; empty: always 1.
  std::function<double(double)> diffusion_ratio;
  std::uint64_t seed = 1;  // of what effects draw at random

  // w of a boundary at rest, a + (b − a)/2 (1 + tanh(s/(2√2 w))): ε for the default well.
  double boundary_width() const { return epsilon / (2 * std::sqrt(well.rho) * (well.b - well.a)); }

  // β of the stabilised tangent: 1 for the default well, as in the reference code. Twice the
  // curvature in the wells, so steps decay while |f0''| ≤ 2β.
  double beta() const { return 4 * well.rho * (well.b - well.a) * (well.b - well.a); }
};

// The model without its RandomEffects.
CahnHilliardModel without_noise(CahnHilliardModel model);

// ε² (K + ρ S) with ρ h_T²/h² in front of the S of a tetrahedron of size h_T: the gradient energy
// is half its quadratic form.
fem::CsrMatrix gradient_energy_matrix(const fem::SurfaceSpace& space,
                                      const CahnHilliardModel& model);

// y = (c, μ):
//   F1 = M̃ ċ + K_M(c) μ + ρ m S μ                (m: scale of the mobility law)
//   F2 = M̃ μ − b(c) − ε² (K + ρ S) c
// and the model's effects. S makes the singular matrices of the trace space regular, vanishes on
// constants and so keeps ∫c. Energy: ∫ f0(c_h) + ½ ε² cᵀ(K + ρ S)c, of which F2 is the gradient
// (not with PotentialRule::nodal).
class CahnHilliard final : public DaeProblem {
 public:
  CahnHilliard(std::shared_ptr<const fem::SurfaceSpace> space, CahnHilliardModel model);

  int block_size() const override { return space_->nodes(); }
  Status residual(double t, VecView y, VecView ydot, VecRef r) const override;
  Status jacobian(double t, VecView y, VecView ydot, double shift, linear::Tangent tangent,
                  linear::BlockJacobian& J) const override;
  Status jacobian_product(double t, VecView y, VecView ydot, double shift, linear::Tangent tangent,
                          VecView v, VecRef product) const override;
  linear::BlockJacobian make_jacobian() const override {
    return linear::BlockJacobian(space_->pattern);
  }
  Status consistent_initial_state(double t, VecRef y, VecRef ydot) const override;
  double norm(VecView y) const override;
  double field_norm(VecView half) const override;  // √(vᵀ M̃ v)
  double mass(VecView y) const override { return space_->integral(c_of(y)); }
  bool conserves_mass() const override;
  double energy(VecView y) const override;
  bool dissipates_energy() const override;
  bool dissipates_in_stabilised_steps() const override;
  bool may_be_extrapolated() const override;
  double longest_step() const override;
  double energy_scale() const override;  // of a surface halfway between the wells
  const Communicator& ranks() const override { return *space_->communicator; }

  // c of a state (c, μ) that does not quite fulfil F2, moved until it does with μ as it is; ∫c
  // stays. Where c has been interpolated, μ from F2 would be rough, and rough parts decay at once.
  Status fit_concentration(double t, VecRef y) const;

  const fem::SurfaceSpace& space() const { return *space_; }
  const CahnHilliardModel& model() const { return model_; }

  // Halves of a state vector.
  Eigen::Ref<const Vec> c_of(VecView y) const { return y.head(block_size()); }
  Eigen::Ref<const Vec> mu_of(VecView y) const { return y.tail(block_size()); }

 private:
  double flux_stabilisation() const;
  double mean_mobility(const fem::CsrMatrix& mobility_stiffness) const;
  void fill_curvature(VecView c, linear::Tangent tangent, linear::BlockJacobian& J) const;

  std::shared_ptr<const fem::SurfaceSpace> space_;
  CahnHilliardModel model_;
  fem::CsrMatrix gradient_energy_;  // ε² (K + ρ S)
};

}  // namespace traceraft::problem
