// The boundary between two equal halves of the unit sphere, in equilibrium on the mesh.
#pragma once

#include "tests/support/spaces.hpp"

namespace traceraft::testing {

// `axis` points from one half to the other. The descent of the energy at fixed mass,
// (ε²(K + ρS) + βM̃) δ = −(b + ε²(K + ρS)c − λw), settles the profile within some ten steps, long
// before the boundary as a whole could move to where the mesh holds it, which changes the energy by
// another 1e-3. β: a little above half the largest f0'' between the wells, below which the energy
// could rise.
inline Vec relaxed_boundary(const fem::SurfaceSpace& sphere,
                            const problem::CahnHilliardModel& model, const Point& axis) {
  problem::InitialRequest halves;
  halves.epsilon = model.epsilon;
  halves.well = model.well;
  halves.caps = {{axis, kPi / 2}};
  const fem::CsrMatrix gradient_energy = problem::gradient_energy_matrix(sphere, model);
  const double beta = 0.6 * model.well.second(model.well.a);
  const fem::CsrMatrix descent = fem::combine(1, gradient_energy, beta, sphere.stabilised_mass);
  Vec c = problem::make_initial_field("caps", sphere, halves), step(sphere.nodes());
  double energy = sphere.quadratic(sphere.stiffness, c);
  for (int iteration = 0; iteration < 100; ++iteration) {
    Vec force = Vec::Zero(sphere.nodes());
    fem::add_potential(sphere, model.well, model.rule, 1, c, force);
    gradient_energy.multiply_add(1, c, force, *sphere.team);
    force -= force.sum() / sphere.area * sphere.node_area;
    if (Status status = sphere.solve_spd(descent, -force, step, 1e-2); !status.ok())
      throw std::runtime_error(status.why);
    c += step;
    const double before = energy;
    energy = sphere.quadratic(sphere.stiffness, c);
    if (std::fabs(energy - before) < 5e-5 * energy) break;
  }
  return c;
}

}  // namespace traceraft::testing
