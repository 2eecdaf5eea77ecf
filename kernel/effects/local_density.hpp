// Effects that are functions of what there is at a point.
#pragma once

#include <functional>

#include "kernel/problem/effect.hpp"

namespace traceraft::effects {

struct DensityPoint {
  Point x;
  double t, c, mu;
};
struct DensityValue {
  double value;
  double by_c = 0, by_mu = 0;  // derivatives
  double energy = 0;           // whose derivative by c the value is, if it is a potential
};

struct LocalDensity {
  std::string name;
  problem::Slot slot;  // source or potential
  bool conserves_mass, dissipates_energy;
  std::function<DensityValue(const DensityPoint&)> value;
};

// source: ċ loses `value`; potential: μ gains it. Integrated by the degree-4 rule on every
// triangle.
problem::EffectPtr local_density(LocalDensity density);

}  // namespace traceraft::effects
