#include <cmath>

#include "kernel/core/random.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/fem/mobility_stiffness.hpp"

namespace traceraft::effects {
namespace {

// A factor G of the products of the four surface gradients, G Gᵀ: two steps of Cholesky's method
// with pivots, as gradients on a surface have rank two.
Eigen::Matrix<double, 4, 2> gradient_factor(const fem::CutElement& element) {
  Eigen::Matrix4d rest = Eigen::Matrix4d::Zero();
  for (int e = 0; e < 6; ++e) {
    const auto& [i, j] = mesh::kTetEdges[e];
    rest(i, j) = rest(j, i) = element.coupling[e];
  }
  rest.diagonal() = -rest.rowwise().sum();
  Eigen::Matrix<double, 4, 2> factor;
  for (int k = 0; k < 2; ++k) {
    Eigen::Index pivot;
    const double largest = rest.diagonal().maxCoeff(&pivot);
    factor.col(k) = rest.col(pivot) / std::sqrt(largest);
    rest -= factor.col(k) * factor.col(k).transpose();
  }
  return factor;
}

// Cook's noise: a random flux √(2 kT M) ξ with ξ white in space and time. In every tetrahedron one
// vector with variance 1/|Γ_T|; in time drawn every τ with variance 1/τ and linear in between, so
// that integrators see a continuous function. A step that is longer than τ would take one draw for
// all of it, and noise as much too strong; longest_step() keeps them below. Draws depend on the
// tetrahedron's place in the mesh, not on the number of ranks. Where lipids are slower, so is their
// noise (`model.diffusion_ratio`).
class ThermalNoise final : public problem::Effect {
 public:
  ThermalNoise(double kT, double tau, std::uint64_t seed, const problem::CahnHilliardModel& model)
      : kT_(kT),
        tau_(tau),
        seed_(seed),
        law_(model.mobility),
        diffusion_ratio_(model.diffusion_ratio) {}

  std::string name() const override { return "thermal"; }
  bool conserves_mass() const override { return true; }
  bool dissipates_energy() const override { return false; }
  double longest_step() const override { return 0.5 * tau_; }
  bool needs_equal_cells() const override { return true; }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView, VecRef residual_c,
                    VecRef) const override {
    const std::vector<double> integral = fem::mobility_integrals(space, *law_, c);
    for (std::size_t e = 0; e < space.elements.size(); ++e)
      add_flux(space, e, std::sqrt(integral[e]), t, residual_c);
  }

  void add_tangent(const fem::SurfaceSpace& space, double t, VecView c, VecView,
                   linear::BlockJacobian& J) const override {
    std::vector<std::array<double, 4>> gradient;
    const std::vector<double> integral = fem::mobility_integrals(space, *law_, c, gradient);
    fem::add_element_matrices(
        space,
        [&](const fem::CutElement&, int e) -> Eigen::Matrix4d {
          return element_flux(space, e, t) * root_derivative(integral[e], gradient[e]).transpose();
        },
        J.cc);
  }

  void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView,
                           VecView direction_c, VecView, VecRef product_c, VecRef) const override {
    std::vector<std::array<double, 4>> gradient;
    const std::vector<double> integral = fem::mobility_integrals(space, *law_, c, gradient);
    for (std::size_t e = 0; e < space.elements.size(); ++e) {
      const Eigen::Vector4d derivative = root_derivative(integral[e], gradient[e]);
      double change = 0;
      for (int i = 0; i < 4; ++i) change += derivative[i] * direction_c[space.elements[e].node[i]];
      add_flux(space, e, change, t, product_c);
    }
  }

 private:
  // ∂√I/∂c_i; 0 where the mobility vanishes, as its noise does.
  static Eigen::Vector4d root_derivative(double integral, const std::array<double, 4>& gradient) {
    if (!(integral > 0)) return Eigen::Vector4d::Zero();
    return Eigen::Map<const Eigen::Vector4d>(gradient.data()) / (2 * std::sqrt(integral));
  }

  // −√(2 kT/τ) G ξ with G Gᵀ = ∇_Γλ_i·∇_Γλ_j, to be multiplied with √∫_T M.
  Eigen::Vector4d element_flux(const fem::SurfaceSpace& space, std::size_t e, double t) const {
    const mesh::ActiveTet& tet = space.mesh.tets[e];
    const auto place = static_cast<std::uint64_t>(space.mesh.node_id[tet.node[0]]) * 6 +
                       static_cast<std::uint64_t>(tet.shape);
    const double when = t / tau_;
    const double begin = std::floor(when), share = when - begin;
    const Eigen::Vector2d flux = (1 - share) * draw(place, begin) + share * draw(place, begin + 1);
    return -std::sqrt(2 * kT_ / tau_ * (diffusion_ratio_ ? diffusion_ratio_(t) : 1)) *
           (gradient_factor(space.elements[e]) * flux);
  }

  Eigen::Vector2d draw(std::uint64_t place, double when) const {
    const auto stream = static_cast<std::uint64_t>(when) + 1000;
    const auto uniform = [&](std::uint64_t k) {
      return uniform_random(seed_, stream, 2 * place + k);
    };
    const auto pair = normal_pair(uniform(0), uniform(1));
    return {pair[0], pair[1]};
  }

  void add_flux(const fem::SurfaceSpace& space, std::size_t e, double weight, double t,
                VecRef r) const {
    const Eigen::Vector4d flux = element_flux(space, e, t);
    for (int i = 0; i < 4; ++i)
      if (const int node = space.elements[e].node[i]; space.mesh.owns(node))
        r[node] += weight * flux[i];
  }

  double kT_, tau_;
  std::uint64_t seed_;
  physics::MobilityPtr law_;
  std::function<double(double)> diffusion_ratio_;
};

}  // namespace

EffectEntry thermal_effect() {
  return {"thermal",
          "thermal fluctuations of the flux (Cook's noise)",
          "",
          {{"strength", "", 0, 0, 1, "kT, in units of the energy density times R^2"},
           {"time", "s", 1e-3, 1e-12, 1e9, "time between draws; steps are at most half as long"},
           {"seed", "", 1, 0, 1e9, "seed of the draws, combined with that of the run",
            ParameterKind::integer}},
          MassClass::conserves,
          EnergyClass::active,
          "differences between vesicles that grow with time",
          {},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const auto own = static_cast<std::uint64_t>(p["seed"]);
            model.effects.push_back(std::make_shared<ThermalNoise>(
                p["strength"], p["time"], (own << 32) + model.seed, model));
          }};
}

}  // namespace traceraft::effects
