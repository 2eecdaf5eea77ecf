#include <mutex>
#include <stdexcept>

#include "kernel/effects/effects.hpp"
#include "kernel/effects/nodal_potential.hpp"

namespace traceraft {
namespace {

// The mean curvature H = (κ₁ + κ₂)/2 at the nodes, 1 on the unit sphere, from −Δ_Γ x = 2 H n:
// ∫ (2 H n) v = ∫ ∇_Γ x·∇_Γ v, with n the direction of the left-hand side's own solution.
Vec mean_curvature(const SurfaceSpace& space) {
  const int n = space.nodes();
  Vec squares = Vec::Zero(n), x(n), load(n), component(n), buffer, sign = Vec::Zero(n);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < n; ++i) x[i] = space.mesh.position(i)[axis];
    load.setZero();
    space.stiffness.multiply_add(1, space.with_ghosts(x, buffer), load, *space.team);
    if (const Status status = space.solve_mass(load, component); !status.ok())
      throw std::runtime_error("the curvature of the surface: " + status.why);
    squares += component.cwiseAbs2();
    sign += component.cwiseProduct(x);  // outwards where it points away from the centre
  }
  Vec curvature = 0.5 * squares.cwiseSqrt();
  for (int i = 0; i < n; ++i)
    if (sign[i] < 0) curvature[i] = -curvature[i];
  return curvature;
}

// Computed once, for the space that it is first asked for.
class Curvature {
 public:
  Vec operator()(const SurfaceSpace& space, ConstVec) {
    const std::lock_guard lock(mutex_);
    if (space_ != &space) {
      value_ = mean_curvature(space);
      space_ = &space;
    }
    return value_;
  }

 private:
  std::mutex mutex_;
  const SurfaceSpace* space_ = nullptr;
  Vec value_;
};

}  // namespace

// Rafts that prefer to be curved: μ = … − Λ H. On a sphere it changes nothing.
EffectEntry curvature_effect() {
  return {"curvature",
          "rafts that prefer curved places; nothing on a sphere",
          {{"strength", "", 0, -10, 10, "Lambda of Lambda H R"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "rafts sorted by curvature",
          {"gravity"},
          [](const Parameters& p, CahnHilliardModel& model) {
            const auto curvature = std::make_shared<Curvature>();
            model.effects.push_back(
                nodal_potential({"curvature", -p["strength"], false,
                                 [curvature](const SurfaceSpace& space, ConstVec c) {
                                   return (*curvature)(space, c);
                                 }}));
          }};
}

}  // namespace traceraft
