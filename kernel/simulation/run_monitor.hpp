// Watches what a solution must keep: mass, and energy that does not grow.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/observables/observables.hpp"
#include "kernel/time/energy_guard.hpp"

namespace traceraft::simulation {

class RunMonitor {
 public:
  // Begins a run. A drift of the mass and a rise of the energy are relative to these scales where
  // mass and energy themselves are nearly zero. `energy_scale`: DaeProblem's.
  void start(const observables::Observables& row, double mass_scale, double energy_scale) {
    initial_mass_ = row.mass;
    mass_scale_ = std::fabs(row.mass) > 1e-3 * mass_scale ? std::fabs(row.mass) : mass_scale;
    initial_energy_ = std::fabs(row.energy) > 1e-3 * energy_scale ? row.energy : energy_scale;
    energy_ = row.energy;
    allowed_rise_ = time::EnergyGuard::allowed_rise(row.energy, energy_scale);
  }
  void accept(const observables::Observables& row) {
    drift_ = std::max(drift_, std::fabs(relative_drift(row)));
    if (const double rise = row.energy - energy_; rise > allowed_rise_) {
      ++rises_;
      largest_rise_ = std::max(largest_rise_, rise / std::fabs(initial_energy_));
    }
    energy_ = row.energy;
  }

  // On another mesh, where the same state has another energy.
  void go_on_from(double energy) { energy_ = energy; }

  double relative_drift(const observables::Observables& row) const {
    return (row.mass - initial_mass_) / mass_scale_;
  }
  double mass_drift() const { return drift_; }  // largest so far
  long energy_rises() const { return rises_; }
  double largest_rise() const { return largest_rise_; }  // over the initial energy

 private:
  double initial_mass_ = 0, mass_scale_ = 1, initial_energy_ = 1, energy_ = 0, drift_ = 0,
         allowed_rise_ = 0, largest_rise_ = 0;
  long rises_ = 0;
};

}  // namespace traceraft::simulation
