// The numbers that a row of series.csv holds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/observables/rafts.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::observables {

// In units of R and R²/D.
struct Observables {
  double t = 0;
  double mass = 0;             // ∫ c
  double energy = 0;           // ∫ f0 + ½ ε² |∇c|²
  double perimeter = 0;        // p0 ∫ ε |∇_Γ c|²
  double perimeter_level = 0;  // length of the curve c = (a + b)/2
  int rafts = 0;
  int domains = 0;           // components of the phase that covers less: rafts, or what is not raft
  double raft_fraction = 0;  // area of {c > (a + b)/2} over |Γ|
  double largest_raft = 0;   // area of the largest raft
  double c_min = 0, c_max = 0;
};

class Observer {
 public:
  // interface_energy: ∫ ε|∇c|² per unit length of phase boundary, see resolved_boundary.hpp.
  // The problem must outlive this object.
  Observer(const problem::CahnHilliard& problem, std::shared_ptr<const fem::SurfaceSpace> space,
           double interface_energy);

  Observables measure(double t, VecView y) const { return measure(t, y, rafts(y)); }
  Observables measure(double t, VecView y, const RaftReport& rafts) const;
  RaftReport rafts(VecView y) const;
  double level() const;
  double mass_scale() const;  // |Γ| (b − a)
  double energy_scale() const { return problem_.energy_scale(); }

 private:
  const problem::CahnHilliard& problem_;
  double interface_energy_;
  RaftFinder finder_;
};

}  // namespace traceraft::observables
