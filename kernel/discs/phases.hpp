// Local equilibrium at the boundary of a disc: what curvature does to the phases on its sides.
#pragma once

#include <vector>

#include "kernel/discs/disc_model.hpp"
#include "kernel/discs/round_boundary.hpp"

namespace traceraft::discs {

// ∫ c over the profile of a straight boundary around a circle, less that of the sharp one: π³δ²/3,
// whatever its radius, with the length δ = ε/√(2ρ). Local equilibrium changes it (RoundBoundary).
double boundary_mass(const physics::DoubleWell& well, double epsilon);
// Two boundaries at this distance join: halfway the sum of their profiles is the concentration of
// the spinodal, from where on c grows by itself. 2 δ ln(2/c_s − 1), six times ε.
double contact_distance(const physics::DoubleWell& well, double epsilon);

// A boundary of curvature κ has the chemical potential μ = σκ (Gibbs and Thomson; the phases differ
// by 1 in c), changed a little as it is diffuse (RoundBoundary, with the radius tan α of the same
// curvature). Both phases beside it have the concentrations with f0'(c) = μ. Diffusion between
// discs follows M(c) ∇μ = ∇G with G' = M f0'': G is harmonic where it is slow.
class Phases {
 public:
  explicit Phases(const DiscModel& model);

  double line_tension() const { return line_tension_; }  // energy per length, ε ∫ √(2 f0) dc
  double potential(double area) const;                   // μ at the boundary of a disc
  // A smaller disc dissolves: it holds hardly less than one of no area.
  double smallest_area() const { return smallest_area_; }

  double outside(double potential) const;  // c of the phase outside, on its stable branch
  double inside(double potential) const;
  double flux_potential(double c) const;  // G, 0 at c = 0; from −¼ to the spinodal

  // How far from the boundary of a disc the phase outside, of concentration c, seems to begin. In
  // the tail of the profile lipids are more mobile than beyond: the resistance ∫ ds/M(s) of a tail
  // M = m + e^(−s/δ) is that of a sharp boundary at δ ln(1 + 1/m), where m = M(c).
  double tail(double c) const;

  // ∫ c over a disc whose level curve ½ encloses `area`, with its boundary.
  double mass(double area) const;
  double mass_slope(double area) const;
  double area_of_mass(double mass) const;     // the inverse
  double boundary_energy(double area) const;  // ∫ f0 + ½ ε² |∇c|² beyond that of both phases
  double diffuse_perimeter(double area) const;  // ∫ ε |∇c|² over that of a straight boundary

  double contact_distance() const { return contact_distance_; }

 private:
  double mobility(double c) const;
  double flux_potential_slope(double c) const;  // M f0''
  RoundBoundaryAt boundary(double area) const;

  physics::MobilityPtr mobility_;
  physics::DoubleWell well_;
  double profile_length_;  // δ
  double line_tension_, largest_potential_, smallest_area_, contact_distance_;
  double lowest_, spacing_;    // of the table
  std::vector<double> table_;  // G
};

}  // namespace traceraft::discs
