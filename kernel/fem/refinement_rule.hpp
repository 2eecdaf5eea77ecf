// How fine a mesh has to be where: fine along the boundaries of the phases.
#pragma once

#include <vector>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::fem {

// θ below. Two rafts vanish within 0.3 % at the same time with 0.0675, 0.1 and 0.135. Above
// 0.14 the rule may let even the middle of a boundary be coarse.
inline constexpr double kBoundaryThreshold = 0.1;

// Sizes h_T = h √(θ/η) for an indicator η: the smallest, h, where η is above the threshold θ, and
// larger ones towards both phases, as the gradient falls off. With the smallest ones in a band and
// the largest beside it, coarsening is 8 % too fast: the tails of the boundaries carry the flux.
struct RefinementRule {
  double threshold;       // θ
  double width;           // η = width |∇_Γ c|
  int finest_generation;  // of tetrahedra of size h

  double indicator(const CutElement& element, VecView c) const;
  int generation(double indicator, double threshold_now) const;
};

// The generation that each tetrahedron of the mesh should have, from 0.5 to 2 times the threshold:
// what lies between stays as it is. Those around a tetrahedron, at its nodes, are as fine as it is.
// `generation`: what they have.
std::vector<int> wanted_generations(const SurfaceSpace& space, const RefinementRule& rule,
                                    VecView c, const std::vector<int>& generation);

// Is a tetrahedron larger than twice the threshold allows?
bool too_coarse(const SurfaceSpace& space, const RefinementRule& rule, VecView c,
                const std::vector<int>& generation);

// The share of the tetrahedra that would be left, at least, with other generations.
double least_share(const std::vector<int>& wanted, const std::vector<int>& generation);

}  // namespace traceraft::fem
