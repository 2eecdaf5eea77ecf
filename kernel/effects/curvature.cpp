#include <stdexcept>

#include "kernel/effects/effects.hpp"
#include "kernel/effects/nodal_potential.hpp"
#include "kernel/effects/per_space.hpp"

namespace traceraft::effects {
namespace {

// ∫ n_k φ_i of a component of the discrete outward normal, for owned nodes.
Vec normal_load(const fem::SurfaceSpace& space, int axis) {
  Vec load = Vec::Zero(space.nodes());
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const fem::CutElement& element = space.elements[e];
    const Point normal = mesh::cut_normal(space.mesh, space.mesh.tets[e]);
    const Eigen::Matrix4d traces = fem::trace_matrix(space.surface, element);
    for (int t = 0; t < element.triangles(); ++t) {
      const double share = space.surface.triangle_area[element.first_triangle + t] / 3;
      for (const int corner : fem::kPolygonTriangles[t])
        for (int i = 0; i < 4; ++i)
          if (const int node = element.node[i]; space.mesh.owns(node))
            load[node] += share * normal[axis] * traces(corner, i);
    }
  }
  return load;
}

// The mean curvature H = (κ₁ + κ₂)/2 at the nodes, 1 on the unit sphere, from −Δ_Γ x = 2 H n:
// ∫ (2 H n) v = ∫ ∇_Γ x·∇_Γ v, along the projected normal.
Vec mean_curvature(const fem::SurfaceSpace& space) {
  const int n = space.nodes();
  Vec curvature = Vec::Zero(n), x(n), load(n), vector(n), normal(n), buffer;
  Vec squares = Vec::Zero(n);
  // ∇_Γ x errs by O(h), and its divergence by O(1). All of h S is needed to smooth that.
  const fem::CsrMatrix smoothing = fem::combine(1, space.mass, space.h(), space.normal_stiffness);
  const auto solve = [&](const Vec& right, Vec& solution) {
    if (const Status status = space.solve_spd(smoothing, right, solution, 1e-14); !status.ok())
      throw std::runtime_error("the curvature of the surface: " + status.why);
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < n; ++i) x[i] = space.mesh.position(i)[axis];
    load.setZero();
    space.stiffness.multiply_add(1, space.with_ghosts(x, buffer), load, *space.team);
    solve(load, vector);
    solve(normal_load(space, axis), normal);
    curvature += 0.5 * vector.cwiseProduct(normal);
    squares += normal.cwiseAbs2();
  }
  // The projected normal is not quite as long as one.
  return curvature.cwiseQuotient(squares.cwiseSqrt().cwiseMax(0.1));
}

}  // namespace

// Rafts that prefer to be curved: μ = … − Λ H. On a sphere it changes nothing.
EffectEntry curvature_effect() {
  return {"curvature",
          "rafts that prefer strongly curved places; nothing on a sphere",
          "rafts that avoid strongly curved places; nothing on a sphere",
          {{"strength", "", 0, -10, 10, "Lambda of Lambda H R"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "rafts sorted by curvature",
          {"gravity"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            const auto curvature =
                std::make_shared<PerSpace<Vec>>([](const fem::SurfaceSpace& space) {
                  return std::make_shared<const Vec>(mean_curvature(space));
                });
            model.effects.push_back(
                nodal_potential({"curvature", -p["strength"], false,
                                 [curvature](const fem::SurfaceSpace& space, VecView) {
                                   return *curvature->on(space);
                                 }}));
          }};
}

}  // namespace traceraft::effects
