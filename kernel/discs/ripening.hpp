// Ripening of discs: lipids diffuse outside them from small ones to large ones.
#pragma once

#include <utility>
#include <vector>

#include "kernel/discs/disc.hpp"
#include "kernel/discs/phases.hpp"

namespace traceraft::discs {

// Areas of discs, and ∫ c over the vesicle.
struct Contents {
  Vec area;
  double mass = 0;
};

// Outside the discs the flux potential G obeys ΔG = −(what the background loses), and at the
// boundary of disc i it is G(c_i), where c_i is in equilibrium with its curvature. Disc j is a
// charge Q_j on its boundary (it takes up Q_j per time) and a dipole p_j at its centre, which its
// neighbours induce:
//   G(c_i) = Ḡ − Σ_j (N_ij Q_j + ∇_j N p_j),
//   0 = Σ_j (∇_i N Q_j + ∇_i ∇_j N p_j) + p_i/(2π a_i²),
//   N_ij = −(ln((1 − cos θ_ij)/2) + ln((1 + cos α_i)/2) + ln((1 + cos α_j)/2) + 1)/(4π),
//   N_ii = −(ln((1 − cos α_i)/2) + ln((1 + cos α_i)/2) + 1)/(4π),
// means over boundaries of Green's function of the sphere. α is the half angle with the tail of the
// profile (Phases::tail), as far as neighbours leave room for it, and a = 2 tan(α/2). Higher
// multipoles are left out: a disc stays round, and where it is.
class Ripening {
 public:
  explicit Ripening(const DiscModel& model) : phases_(model), uptake_(model.uptake) {}

  const Phases& phases() const { return phases_; }

  // For the discs in these places, until they change.
  void set_places(const std::vector<Disc>& discs);
  // d/dt of the contents. False if the discs are such that there is none.
  bool rate(const Contents& contents, Contents& result) const;
  // Charges and dipoles that were found last. The next solve begins with them, so that whoever goes
  // on bitwise keeps them.
  const Vec& charges() const { return charges_; }
  void set_charges(Vec charges) { charges_ = std::move(charges); }
  // The mean of c outside the discs: they do not hold the rest of the mass.
  double background(const Contents& contents) const;

 private:
  // `outside`: c beside each disc.
  Vec half_angles_with_tails(const Vec& area, const Vec& outside) const;
  bool solve_charges(const Vec& angle, const Vec& difference, Vec& charge) const;
  void add_near_fluxes(const Vec& angle, const Vec& potential, Vec& charge) const;
  Vec product(const Vec& caps, const Vec& own, const Vec& x) const;

  Phases phases_;
  double uptake_;
  // These depend on the places alone: ln((1 − cos θ_ij)/2) and θ_ij for i > j; and the lower half
  // of the matrix of charges and dipoles (two directions each) without the diagonal and the caps.
  Eigen::MatrixXd logarithms_, angles_;
  Eigen::MatrixXf between_;  // single precision is exact enough, and twice as fast
  mutable Vec charges_;      // and dipoles that were found last, to begin with
};

}  // namespace traceraft::discs
