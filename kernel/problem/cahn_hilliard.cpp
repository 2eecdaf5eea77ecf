#include "kernel/problem/cahn_hilliard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/fem/mobility_stiffness.hpp"

namespace traceraft::problem {

CahnHilliardModel without_noise(CahnHilliardModel model) {
  const auto random = [](const EffectPtr& effect) {
    return dynamic_cast<const RandomEffect*>(effect.get()) != nullptr;
  };
  model.effects.erase(std::remove_if(model.effects.begin(), model.effects.end(), random),
                      model.effects.end());
  return model;
}

// F2 along normals: 0.3 h_T S_T μ = ε² ρ_T S_T c. Large tetrahedra need a ρ_T that grows faster
// than h_T, or a small normal gradient of μ goes with a large one of c, and that of c lasts long:
// with h_T²/h in place of h, 183 iterations of a linear solve become 26.
fem::CsrMatrix gradient_energy_matrix(const fem::SurfaceSpace& space,
                                      const CahnHilliardModel& model) {
  const double e2 = model.epsilon * model.epsilon;
  return fem::combine(e2, space.stiffness, e2 * model.stabilisation * space.h(),
                      space.graded_normal_stiffness);
}

CahnHilliard::CahnHilliard(std::shared_ptr<const fem::SurfaceSpace> space, CahnHilliardModel model)
    : space_(std::move(space)),
      model_(std::move(model)),
      gradient_energy_(gradient_energy_matrix(*space_, model_)) {}

double CahnHilliard::flux_stabilisation() const {
  return model_.stabilisation * space_->h() * model_.mobility->scale();
}

Status CahnHilliard::residual(double t, VecView y, VecView ydot, VecRef r) const {
  const fem::SurfaceSpace& space = *space_;
  const int n = block_size();
  Vec c_buffer, mu_buffer, rate_buffer;
  const auto c = space.with_ghosts(c_of(y), c_buffer);
  const auto mu = space.with_ghosts(mu_of(y), mu_buffer);
  const auto rate = space.with_ghosts(c_of(ydot), rate_buffer);
  r.setZero();
  VecRef first = r.head(n), second = r.tail(n);

  space.stabilised_mass.multiply_add(1, rate, first, *space.team);
  fem::add_mobility_flux(space, fem::mobility_integrals(space, *model_.mobility, c), mu, first);
  space.normal_stiffness.multiply_add(flux_stabilisation(), mu, first, *space.team);

  space.stabilised_mass.multiply_add(1, mu, second, *space.team);
  fem::add_potential(space, model_.well, model_.rule, -1, c, second);
  gradient_energy_.multiply_add(-1, c, second, *space.team);

  for (const EffectPtr& effect : model_.effects)
    effect->add_residual(space, t, c, mu, first, second);
  if (!std::isfinite(ranks().sum(fem::dot(r, r))))
    return Status::retry("the residual is not finite");
  return {};
}

void CahnHilliard::fill_curvature(VecView c, linear::Tangent tangent,
                                  linear::BlockJacobian& J) const {
  const double beta = tangent == linear::Tangent::stabilised ? model_.beta() : 0;
  space_->team->for_range(J.mc.values.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      J.mc.values[k] = -gradient_energy_.values[k] - beta * J.mm.values[k];
  });
  J.curvature = beta;
  if (tangent == linear::Tangent::stabilised) return;
  fem::add_potential_tangent(*space_, model_.well, model_.rule, -1, c, J.mc);
  double convex = 0;
  for (int i = 0; i < block_size(); ++i)
    convex += space_->node_area[i] * std::max(0.0, model_.well.second(c[i]));
  J.curvature = ranks().sum(convex) / space_->area;
}

double CahnHilliard::mean_mobility(const fem::CsrMatrix& mobility_stiffness) const {
  double weighted = 0, unweighted = 0;
  for (const int k : space_->pattern->diagonal) {
    weighted += mobility_stiffness.values[k];
    unweighted += space_->stiffness.values[k];
  }
  return ranks().sum(weighted) / ranks().sum(unweighted);
}

Status CahnHilliard::jacobian(double t, VecView y, VecView, double shift, linear::Tangent tangent,
                              linear::BlockJacobian& J) const {
  const fem::SurfaceSpace& space = *space_;
  if (!std::isfinite(ranks().sum(fem::dot(y, y)))) return Status::retry("the state is not finite");
  Vec c_buffer, mu_buffer;
  const auto c = space.with_ghosts(c_of(y), c_buffer);
  const auto mu = space.with_ghosts(mu_of(y), mu_buffer);
  J.shift = shift;
  J.tangent = tangent;
  J.stiffness = model_.epsilon * model_.epsilon;
  const std::size_t entries = J.cc.values.size();
  space.team->for_range(entries, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      J.mm.values[k] = space.stabilised_mass.values[k];
      J.cc.values[k] = shift * space.stabilised_mass.values[k];
    }
  });

  std::vector<double> integral;
  if (tangent == linear::Tangent::exact) {
    std::vector<std::array<double, 4>> gradient;
    integral = fem::mobility_integrals(space, *model_.mobility, c, gradient);
    fem::add_mobility_derivative(space, 1, mu, gradient, J.cc);
  } else {
    integral = fem::mobility_integrals(space, *model_.mobility, c);
  }
  fem::assemble_mobility_stiffness(space, integral, J.cm);
  fill_curvature(c, tangent, J);
  for (const EffectPtr& effect : model_.effects) {
    if (tangent == linear::Tangent::exact)
      effect->add_tangent(space, t, c, mu, J);
    else
      effect->add_stabilised(space, t, c, J);
  }
  J.mobility = mean_mobility(J.cm);
  const double rho = flux_stabilisation();
  space.team->for_range(entries, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      J.cm.values[k] += rho * space.normal_stiffness.values[k];
  });
  return {};
}

Status CahnHilliard::jacobian_product(double t, VecView y, VecView, double shift,
                                      linear::Tangent tangent, VecView v, VecRef product) const {
  const fem::SurfaceSpace& space = *space_;
  const int n = block_size();
  Vec buffers[4];
  const auto c = space.with_ghosts(c_of(y), buffers[0]);
  const auto mu = space.with_ghosts(mu_of(y), buffers[1]);
  const auto vc = space.with_ghosts(c_of(v), buffers[2]);
  const auto vmu = space.with_ghosts(mu_of(v), buffers[3]);
  product.setZero();
  VecRef first = product.head(n), second = product.tail(n);
  space.stabilised_mass.multiply_add(shift, vc, first, *space.team);
  space.normal_stiffness.multiply_add(flux_stabilisation(), vmu, first, *space.team);
  space.stabilised_mass.multiply_add(1, vmu, second, *space.team);
  gradient_energy_.multiply_add(-1, vc, second, *space.team);

  if (tangent == linear::Tangent::stabilised) {
    fem::add_mobility_flux(space, fem::mobility_integrals(space, *model_.mobility, c), vmu, first);
    space.stabilised_mass.multiply_add(-model_.beta(), vc, second, *space.team);
    for (const EffectPtr& effect : model_.effects)
      effect->add_stabilised_product(space, t, c, vmu, first);
    return {};
  }
  std::vector<std::array<double, 4>> gradient;
  fem::add_mobility_flux(space, fem::mobility_integrals(space, *model_.mobility, c, gradient), vmu,
                         first);
  fem::add_mobility_flux(space, fem::mobility_change(space, gradient, vc), mu, first);
  fem::add_potential_tangent_product(space, model_.well, model_.rule, -1, c, vc, second);
  for (const EffectPtr& effect : model_.effects)
    effect->add_tangent_product(space, t, c, mu, vc, vmu, first, second);
  return {};
}

Status CahnHilliard::consistent_initial_state(double t, VecRef y, VecRef ydot) const {
  const int n = block_size();
  y.tail(n).setZero();
  ydot.setZero();
  Vec r(size());
  if (Status status = residual(t, y, ydot, r); !status.ok()) return status;
  Vec mu(n);
  if (Status status = space_->solve_mass(-r.tail(n), mu); !status.ok()) return status;
  y.tail(n) = mu;
  if (Status status = residual(t, y, ydot, r); !status.ok()) return status;
  Vec rate(n);
  if (Status status = space_->solve_mass(-r.head(n), rate); !status.ok()) return status;
  ydot.head(n) = rate;
  return {};
}

// Corrections with ε² (K + ρ S) + β M̃ in place of the tangent, which is not definite.
Status CahnHilliard::fit_concentration(double t, VecRef y) const {
  constexpr int kCorrections = 3;
  const int n = block_size();
  const fem::CsrMatrix matrix =
      fem::combine(1, gradient_energy_, model_.beta(), space_->stabilised_mass);
  const Vec rest = Vec::Zero(size());
  Vec r(size()), correction(n);
  const double mass = this->mass(y);
  for (int k = 0; k < kCorrections; ++k) {
    if (Status status = residual(t, y, rest, r); !status.ok()) return status;
    if (Status status = space_->solve_spd(matrix, r.tail(n), correction, 1e-6); !status.ok())
      return status;
    y.head(n) += correction;
  }
  y.head(n).array() += (mass - this->mass(y)) / space_->area;
  return {};
}

double CahnHilliard::norm(VecView y) const {
  return std::sqrt(std::max(0.0, space_->inner(c_of(y), c_of(y))));
}

double CahnHilliard::field_norm(VecView half) const {
  return std::sqrt(std::max(0.0, space_->quadratic(space_->stabilised_mass, half)));
}

double CahnHilliard::energy(VecView y) const {
  Vec buffer;
  const auto c = space_->with_ghosts(c_of(y), buffer);
  double energy = ranks().sum(fem::potential_energy(*space_, model_.well, model_.rule, c)) +
                  0.5 * space_->quadratic(gradient_energy_, c_of(y));
  for (const EffectPtr& effect : model_.effects) energy += effect->energy(*space_, c);
  return energy;
}

bool CahnHilliard::conserves_mass() const {
  return std::all_of(model_.effects.begin(), model_.effects.end(),
                     [](const EffectPtr& effect) { return effect->conserves_mass(); });
}

double CahnHilliard::energy_scale() const {
  return space_->area * model_.well.energy(0.5 * (model_.well.a + model_.well.b));
}

bool CahnHilliard::dissipates_energy() const {
  // F2 is not the gradient of the energy with the nodal rule.
  return model_.rule != fem::PotentialRule::nodal &&
         std::all_of(model_.effects.begin(), model_.effects.end(),
                     [](const EffectPtr& effect) { return effect->dissipates_energy(); });
}

bool CahnHilliard::dissipates_in_stabilised_steps() const {
  return dissipates_energy() &&
         std::all_of(model_.effects.begin(), model_.effects.end(),
                     [](const EffectPtr& effect) { return effect->dissipates_explicitly(); });
}

bool CahnHilliard::may_be_extrapolated() const {
  return std::all_of(model_.effects.begin(), model_.effects.end(),
                     [](const EffectPtr& effect) { return effect->may_be_extrapolated(); });
}

double CahnHilliard::longest_step() const {
  double longest = std::numeric_limits<double>::infinity();
  for (const EffectPtr& effect : model_.effects)
    longest = std::min(longest, effect->longest_step());
  return longest;
}

}  // namespace traceraft::problem
