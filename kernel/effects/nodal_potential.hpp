// Potentials that are nodal fields, linear in c.
#pragma once

#include <functional>

#include "kernel/problem/effect.hpp"

namespace traceraft::effects {

// μ gains strength · u, with u = field(space, c) computed as often as it is asked for.
// `linear`: u depends on c, linearly and symmetrically: ∫ v field(w) = ∫ w field(v). Otherwise c is
// ignored. Energy: strength ∫ u c, half of it if linear.
struct NodalPotential {
  std::string name;
  double strength;
  bool linear;
  std::function<Vec(const fem::SurfaceSpace&, VecView)> field;  // owned c to owned u
};
problem::EffectPtr nodal_potential(NodalPotential potential);

}  // namespace traceraft::effects
