// Refuses steps that gain energy where the model can only lose it.
#pragma once

#include <cmath>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/problem/dae_problem.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::time {

// Between accepted states the energy of a model with a mobility ≥ 0 falls; a step that lets it grow
// by more than roundoff is wrong whatever its error estimate says. Does nothing unless the settings
// ask for it.
class EnergyGuard {
 public:
  // The rise that does not count as growth: 1e-10 of the first energy, and roundoff.
  static double allowed_rise(double first_energy, double energy_scale) {
    return 1e-10 * std::fabs(first_energy) + 1e-13 * energy_scale;
  }

  EnergyGuard(const problem::DaeProblem& problem, const IntegratorSettings& settings)
      : problem_(problem), active_(settings.reject_energy_rises && problem.dissipates_energy()) {}

  bool active() const { return active_; }
  void start(VecView y);
  // retry if the energy of y, the result of a step, is larger than that of the last accepted state.
  Status judge(VecView y);
  // The state judged last is accepted.
  void accept() { energy_ = candidate_; }

  long refused() const { return refused_; }
  void save(CheckpointOut out) const;
  // y: the state that goes on; on another mesh, its energy there is what counts.
  void load(CheckpointIn in, VecView y);

 private:
  const problem::DaeProblem& problem_;
  bool active_;
  double allowed_ = 0, energy_ = 0, candidate_ = 0;
  long refused_ = 0;
};

}  // namespace traceraft::time
