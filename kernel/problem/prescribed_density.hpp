// An effect that is a given function of place and time. Manufactured solutions are driven by it.
#pragma once

#include <functional>

#include "kernel/fem/density_load.hpp"
#include "kernel/problem/effect.hpp"

namespace traceraft::problem {

// g(point, t) on Γ_h.
using Density = std::function<double(const fem::QuadraturePoint&, double)>;

// A source ∫ g v in F1 or a potential ∫ g v in F2. Throws std::invalid_argument for a flux.
EffectPtr prescribed_density(std::string name, Slot slot, Density density);

}  // namespace traceraft::problem
