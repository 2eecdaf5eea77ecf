// Ripening of discs: lipids diffuse outside them from small ones to large ones.
#pragma once

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
// charge Q_j on its boundary (it takes up Q_j per time):
//   G(c_i) = Ḡ − Σ_j N_ij Q_j,
//   N_ij = −(ln((1 − cos θ_ij)/2) + ln((1 + cos α_i)/2) + ln((1 + cos α_j)/2) + 1)/(4π),
//   N_ii = −(ln((1 − cos α_i)/2) + ln((1 + cos α_i)/2) + 1)/(4π),
// which are means over boundaries of Green's function of the sphere. α is the half angle with the
// tail of the profile (Phases::tail), as far as neighbours leave room for it. Dipoles are left out:
// a disc stays round, and where it is.
class Ripening {
 public:
  explicit Ripening(const DiscModel& model) : phases_(model), uptake_(model.uptake) {}

  const Phases& phases() const { return phases_; }

  // For the discs in these places, until they change.
  void set_places(const std::vector<Disc>& discs);
  // d/dt of the contents. False if the discs are such that there is none.
  bool rate(const Contents& contents, Contents& result) const;
  // The mean of c outside the discs: they do not hold the rest of the mass.
  double background(const Contents& contents) const;

 private:
  Phases phases_;
  double uptake_;
  Vec half_angles_with_tails(const Vec& area) const;

  Eigen::MatrixXd logarithms_, angles_;  // ln((1 − cos θ_ij)/2), θ_ij; for i > j
};

}  // namespace traceraft::discs
