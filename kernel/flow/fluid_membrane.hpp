// A membrane as a fluid of two dimensions between two waters: the numbers that describe it, and the
// friction of its flow on a sphere. Saffman, Delbrück, PNAS 72 (1975); Henle, Levine, Phys. Rev. E
// 81 (2010).
#pragma once

namespace traceraft::flow {

// The membrane has the viscosity η_m and a size R, and the water on both sides η_w. D is the
// mobility prefactor of lipids, e the unit of the energy density. Lengths are in R, times in R²/D.
struct FluidMembrane {
  double capillary = 0;  // A = e R²/(η_m D): how fast line tension moves the membrane
  double water = 1.25;   // W = R η_w/η_m: drag of the water; R/(2 W) is the length of Saffman
  double thermal = 0;    // Θ = k_B T/(η_m D): how fast Brownian motion does

  // The friction of a stream function of degree l, with the velocity n × ∇ψ, in units of η_m/R⁴:
  // that of the membrane, (l − 1)(l + 2), which rotations do not feel, and that of the water,
  // W (2l + 1); times l (l + 1).
  double friction(int l) const { return ((l - 1.0) * (l + 2) + water * (2 * l + 1)) * l * (l + 1); }
  // The mean square displacement per time, in Brownian flow, of a cap with this half angle.
  double spreading_rate(double half_angle) const;
};

// A of a line tension σ and a boundary of width ε: σ = e ε I with I, the energy of a boundary of
// width 1, from the wells (physics::DoubleWell::interface_energy). σ and η_m are in units of a
// force and of that force times R/D.
double capillary_number(double line_tension, double epsilon, double interface_energy,
                        double membrane_viscosity);

// The highest degrees that count. Waves shorter than a boundary is wide carry next to no force, and
// move as l⁻⁴ of it; in Brownian flow they would only broaden it.
int capillary_degree(double epsilon);
int brownian_degree(double epsilon);

// The time between two draws of a Brownian velocity, which is linear in between. In it a small
// raft, of a radius of 5 ε, moves by half of ε. On other surfaces than the sphere it is that of a
// sphere.
double hold_of(const FluidMembrane& membrane, double epsilon);

}  // namespace traceraft::flow
