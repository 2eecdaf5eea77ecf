// Correlated Brownian motion of discs in a fluid membrane.
#pragma once

#include <vector>

#include "kernel/discs/disc.hpp"
#include "kernel/flow/fluid_membrane.hpp"

namespace traceraft::discs {

// A disc moves with the mean velocity of the membrane in it, and the velocity n × ∇ψ is that of
// thermal forces: harmonics of degree l have the variance 2Θ/friction(l) per time. With the weight
// F_l(α) = 2 P_l'(cos α)/(l (l + 1)) of a disc, the displacements of two discs at the angle θ have
// per time the covariances
//   along the line between them   Σ_l S_l P_l'(x),
//   across                        Σ_l S_l (l (l + 1) P_l(x) − x P_l'(x)),
//   S_l = 2Θ F_l(α_i) F_l(α_j) (2l + 1)/(4π friction(l)),   x = cos θ,
// the derivatives of that of ψ by the places of both. It is without divergence, so that there is no
// drift. A pair of discs that nearly touch moves nearly as one.
class BrownianMotion {
 public:
  explicit BrownianMotion(const flow::FluidMembrane& membrane) : membrane_(membrane) {}

  bool none() const { return membrane_.thermal == 0; }
  void set_discs(const std::vector<Disc>& discs);
  // The largest variance per time of a displacement in one direction, of any discs.
  double largest_variance(const std::vector<Disc>& discs) const;
  // The same of the distance of two discs.
  double variance_of_distance(std::size_t i, std::size_t j) const;
  // Displacements in the time `step` from independent normal numbers, two of each disc. Tangent
  // vectors, in R. Empty if the covariance cannot be factorised.
  std::vector<Point> displacements(double step, const Vec& normal) const;

 private:
  flow::FluidMembrane membrane_;
  std::vector<Disc> discs_;
  Eigen::MatrixXd along_, across_;  // of pairs; on the diagonal the same
};

}  // namespace traceraft::discs
