// How fine a mesh has to be where: fine along the boundaries of the phases.
#pragma once

#include <vector>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::fem {

// `width` |∇_Γ c| on each tetrahedron.
std::vector<double> boundary_indicator(const SurfaceSpace& space, double width, VecView c);

// Sizes h_T = h √(θ/η) for an indicator η: the smallest, h, where η is above the threshold θ, and
// larger ones towards both phases, as the gradient falls off. With the smallest ones in a band and
// the largest beside it, coarsening is 8 % too fast: the tails of the boundaries carry the flux.
struct RefinementRule {
  double threshold;  // θ
  int finest_generation = 0;

  int generation(double indicator, double threshold_now) const;
};

// The generation that each tetrahedron of the mesh should have, from 0.5 to 2 times the threshold:
// what lies between stays as it is. Those around a tetrahedron, at its nodes, are as fine as it is.
// `generation`: what they have.
std::vector<int> wanted_generations(const SurfaceSpace& space, const RefinementRule& rule,
                                    const std::vector<double>& indicator,
                                    const std::vector<int>& generation);

// Is a tetrahedron larger than twice the threshold allows?
bool too_coarse(const RefinementRule& rule, const std::vector<double>& indicator,
                const std::vector<int>& generation);

}  // namespace traceraft::fem
