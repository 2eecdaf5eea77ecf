#include "kernel/observables/perimeter_calibration.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include "kernel/problem/initial_data.hpp"

namespace traceraft {
namespace {

Vec half_and_half(const SurfaceSpace& sphere, const DoubleWell& well, double epsilon,
                  const Point& axis) {
  Vec c(sphere.nodes());
  for (int i = 0; i < sphere.nodes(); ++i) {
    const Point x = sphere.mesh.position(i);
    c[i] = well.profile(std::atan2(axis.cross(x).norm(), axis.dot(x)) - kPi / 2, epsilon);
  }
  return project(sphere, c);
}

}  // namespace

std::optional<Vec> relaxed_boundary(const SurfaceSpace& sphere, const CahnHilliardModel& model,
                                    const Point& axis) {
  const DoubleWell& well = model.well;
  const CsrMatrix gradient_energy = gradient_energy_matrix(sphere, model);
  // Descent of the energy at fixed mass, (ε²(K + ρS) + βM̃) δ = −(b + ε²(K + ρS)c − λw): the profile
  // settles within some ten steps, long before the boundary as a whole could move to where the mesh
  // holds it, which changes the energy by another 1e-3. β: a little above half the largest f0''
  // between the wells, below which the energy could rise.
  const double beta = 0.6 * well.second(well.a);
  const CsrMatrix descent = combine(1, gradient_energy, beta, sphere.stabilised_mass);
  Vec c = half_and_half(sphere, well, model.epsilon, axis), step(sphere.nodes()), buffer;
  double energy = sphere.quadratic(sphere.stiffness, c);
  for (int iteration = 0; iteration < 100; ++iteration) {
    Vec force = Vec::Zero(sphere.nodes());
    const auto local = sphere.with_ghosts(c, buffer);
    add_potential(sphere, well, model.rule, 1, local, force);
    gradient_energy.multiply_add(1, local, force, *sphere.team);
    force -= sphere.communicator->sum(force.sum()) / sphere.area * sphere.node_area;
    if (Status status = sphere.solve_spd(descent, -force, step, 1e-2); !status.ok())
      return std::nullopt;
    c += step;
    const double before = energy;
    energy = sphere.quadratic(sphere.stiffness, c);
    if (std::fabs(energy - before) < 5e-5 * energy) break;
  }
  return c;
}

double relaxed_interface_energy(const SurfaceSpace& sphere, const CahnHilliardModel& model,
                                const Point& axis) {
  const std::optional<Vec> c = relaxed_boundary(sphere, model, axis);
  return c ? model.epsilon * sphere.quadratic(sphere.stiffness, *c) / (2 * kPi) : 0;
}

PerimeterCalibration calibrate_perimeter(const SurfaceSpace& sphere,
                                         const CahnHilliardModel& model) {
  const double exact = model.well.interface_energy();
  const std::array<Point, 4> axes = {Point(0, 0, 1), Point(1, 2, 3), Point(-3, 1, 1.7),
                                     Point(2, -1, 0.5)};
  std::array<double, 4> energies{};
  sphere.team->run([&](int part) {
    for (std::size_t k = part; k < axes.size(); k += sphere.team->size())
      energies[k] = relaxed_interface_energy(sphere, model, axes[k].normalized());
  });
  double energy = 0;
  for (const double each : energies) energy += each / axes.size();
  const double resolved = energy / exact;
  // For ε above about R/3 two phases do not coexist and there is no boundary to measure.
  return {resolved > 0.5 ? energy : exact, resolved};
}

}  // namespace traceraft
