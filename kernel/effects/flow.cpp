#include <algorithm>
#include <cmath>

#include "kernel/effects/effects.hpp"
#include "kernel/effects/per_space.hpp"
#include "kernel/flow/harmonic_multiplier.hpp"
#include "kernel/flow/transport.hpp"

namespace traceraft::effects {
namespace {

// The friction of a stream function on the unit sphere, by degree: that of the membrane,
// (l − 1)(l + 2), which rotations do not feel, and that of the water on both sides, W (2l + 1);
// times l (l + 1), as the velocity is n × ∇ψ.
double stream_friction(int l, double water) {
  return ((l - 1.0) * (l + 2) + water * (2 * l + 1)) * l * (l + 1);
}

// Waves shorter than a boundary is wide carry next to no force, and move as l⁻⁴ of it.
int degree_of_flow(double epsilon) {
  return static_cast<int>(std::clamp(std::ceil(1.6 / epsilon), 16.0, 64.0));
}

struct FlowOperators {
  std::vector<flow::ElementCurl> curls;
  flow::HarmonicMultiplier mobility;  // from a force to the stream function
};

std::shared_ptr<const FlowOperators> operators_of(const fem::SurfaceSpace& space, double water,
                                                  double epsilon) {
  Vec gain = Vec::Zero(degree_of_flow(epsilon) + 1);
  // The capillary force turns no sphere as a whole: its torque, l = 1, is an error of the mesh.
  for (int l = 2; l < gain.size(); ++l) gain[l] = 1 / stream_friction(l, water);
  std::vector<Point> nodes;
  for (int i = 0; i < space.nodes(); ++i) nodes.push_back(space.mesh.position(i));
  return std::make_shared<const FlowOperators>(
      FlowOperators{flow::element_curls(space), {nodes, gain, space.team, space.communicator}});
}

// Boundaries pull the membrane, a fluid of two dimensions, and it carries them along:
//   ∂c/∂t + u·∇c = …,   u = n × ∇ψ,   friction(ψ) = −A n·(∇μ × ∇c).
// In weak form the transport is −T(c, ψ, v) in F1 and the force A T(c, μ, ·), with one trilinear
// form T that is antisymmetric in its last two: dE/dt gains −friction(ψ, ψ)/A exactly.
class CapillaryFlow final : public problem::Effect {
 public:
  CapillaryFlow(double capillary, double water, double epsilon)
      : capillary_(capillary), operators_([water, epsilon](const fem::SurfaceSpace& space) {
          return operators_of(space, water, epsilon);
        }) {}

  std::string name() const override { return "flow"; }
  bool conserves_mass() const override { return true; }
  bool dissipates_energy() const override { return true; }
  bool dissipates_explicitly() const override { return false; }
  bool tangent_is_assembled() const override { return false; }

  void require_surface(const fem::SurfaceSpace& space) const override {
    double off = 0;
    for (const Point& x : space.surface.position) off = std::max(off, std::fabs(x.norm() - 1));
    if (space.communicator->max(off) > space.h() * space.h())
      throw InputError("effect flow: it is made for the sphere, and this surface is another");
  }

  void add_residual(const fem::SurfaceSpace& space, double, VecView c, VecView mu,
                    VecRef residual_c, VecRef) const override {
    const auto operators = operators_.on(space);
    Vec buffer;
    const Vec psi = stream(space, *operators, c, mu);
    flow::add_transport(space, operators->curls, -1, c, space.with_ghosts(psi, buffer), residual_c);
  }
  void add_tangent(const fem::SurfaceSpace& space, double, VecView c, VecView mu,
                   linear::BlockJacobian& J) const override {
    const auto operators = operators_.on(space);
    Vec buffer;
    const Vec psi = stream(space, *operators, c, mu);
    flow::add_transport_matrix(space, operators->curls, -1, space.with_ghosts(psi, buffer), J.cc);
  }
  void add_tangent_product(const fem::SurfaceSpace& space, double, VecView c, VecView mu,
                           VecView direction_c, VecView direction_mu, VecRef product_c,
                           VecRef) const override {
    const auto operators = operators_.on(space);
    const auto& curls = operators->curls;
    Vec buffer, change = Vec::Zero(space.nodes());
    const Vec psi = stream(space, *operators, c, mu);
    flow::add_transport(space, curls, -1, direction_c, space.with_ghosts(psi, buffer), product_c);
    flow::add_transport(space, curls, capillary_, direction_c, mu, change);
    flow::add_transport(space, curls, capillary_, c, direction_mu, change);
    change = operators->mobility.apply(change);
    flow::add_transport(space, curls, -1, c, space.with_ghosts(change, buffer), product_c);
  }

 private:
  Vec stream(const fem::SurfaceSpace& space, const FlowOperators& operators, VecView c,
             VecView mu) const {
    Vec force = Vec::Zero(space.nodes());
    flow::add_transport(space, operators.curls, capillary_, c, mu, force);
    return operators.mobility.apply(force);
  }

  double capillary_;
  mutable PerSpace<FlowOperators> operators_;
};

}  // namespace

// Hydrodynamics of a fluid membrane between two waters, with the membrane viscosity η_m and that of
// the water η_w: Saffman, Delbrück, PNAS 72 (1975); Henle, Levine, Phys. Rev. E 81 (2010).
EffectEntry flow_effect() {
  return {"flow",
          "flow of the membrane, driven by the line tension of rafts",
          "",
          {{"capillary", "", 0, 0, 1e12, "A = e R^2/(eta_m D), with the unit e of energy density"},
           {"water", "", 1.25, 1e-3, 1e3, "W = R eta_w/eta_m, the drag of the water"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "rafts that become round and merge faster",
          {"mobility-contrast"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            model.effects.push_back(
                std::make_shared<CapillaryFlow>(p["capillary"], p["water"], model.epsilon));
          }};
}

}  // namespace traceraft::effects
