// Mobility laws M(c), in units of the prefactor D. One file per law, one line in mobilities.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::physics {

// Contract: M is continuous; it may be negative outside [0, 1]. What enters the equations is the
// mean of M(c_h) over Γ_h in each tetrahedron, floored at zero there (fem/mobility_stiffness.hpp):
// without the floor a slightly negative mobility amplifies itself without bound.
class Mobility {
 public:
  virtual ~Mobility() = default;
  // value[i] = M(c[i]) and, if derivative is not null, derivative[i] = M'(c[i]).
  virtual void evaluate(const double* c, int count, double* value, double* derivative) const = 0;
  // Typical size of M in a phase boundary: scales the stabilisation of the flux.
  virtual double scale() const = 0;
  // Does M vary with c? A constant law allows factors to be kept.
  virtual bool constant() const { return false; }
};

using MobilityPtr = std::shared_ptr<const Mobility>;

struct MobilityEntry {
  std::string name;
  std::string summary;
  std::vector<ParameterSpec> parameters;
  std::function<MobilityPtr(const Parameters&)> make;
};

MobilityEntry degenerate_mobility();
MobilityEntry constant_mobility();

const NamedList<MobilityEntry>& mobilities();

// "constant:value=0.25" -> the law. Throws InputError.
MobilityPtr make_mobility(const std::string& specification);

}  // namespace traceraft::physics
