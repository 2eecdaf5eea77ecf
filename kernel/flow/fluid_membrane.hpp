// A spherical membrane as a fluid of two dimensions between two waters: friction of its flow, and
// the numbers that describe it. Saffman, Delbrück, PNAS 72 (1975); Henle, Levine, Phys. Rev. E 81
// (2010).
#pragma once

namespace traceraft::flow {

// Of a membrane with viscosity η_m on a sphere of radius R, water with viscosity η_w on both sides,
// lipids with the mobility prefactor D, and e as the unit of the energy density. Lengths are in R,
// times in R²/D.
struct FluidMembrane {
  double capillary = 0;  // A = e R²/(η_m D): how fast line tension moves the membrane
  double water = 1.25;   // W = R η_w/η_m: drag of the water; R/(2 W) is the length of Saffman
  double thermal = 0;    // Θ = k_B T/(η_m D): how fast Brownian motion does

  // The friction of a stream function of degree l, with the velocity n × ∇ψ, in units of η_m/R⁴:
  // that of the membrane, (l − 1)(l + 2), which rotations do not feel, and that of the water,
  // W (2l + 1); times l (l + 1).
  double friction(int l) const { return ((l - 1.0) * (l + 2) + water * (2 * l + 1)) * l * (l + 1); }
  // The mean square displacement of a point per time in Brownian flow.
  double spreading_rate() const;
};

// A of a line tension σ and a boundary of width ε: σ = e ε/(6√2). σ and η_m are in units of a force
// and of that force times R/D.
double capillary_number(double line_tension, double epsilon, double membrane_viscosity);

// The highest degrees that count. Waves shorter than a boundary is wide carry next to no force, and
// move as l⁻⁴ of it; in Brownian flow they would only broaden it.
int capillary_degree(double epsilon);
int brownian_degree(double epsilon);

// The time for which a Brownian velocity is held: a point moves a quarter of ε in it. It does not
// depend on the highest degree.
double hold_of(const FluidMembrane& membrane, double epsilon);

}  // namespace traceraft::flow
