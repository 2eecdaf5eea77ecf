// From a state at one time to the next, with all that linear perturbations of the way need.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::assimilation {

// Times at which a linear perturbation is advanced: fine at first, where a state that was put
// together from measurements relaxes, and coarser later. Two-stage SDIRK method of Alexander
// (1977): order 2, stiffly accurate and L-stable, one matrix per stage with the same shift.
struct TangentGrid {
  std::vector<double> stage_times;  // two per step; the second is the end of the step
  std::vector<double> steps;

  // Steps grow linearly.
  static TangentGrid graded(double begin, double end, int steps);
};

struct TangentPath {
  TangentGrid grid;
  std::vector<Vec> stages;  // y at the grid's stage times
};

struct Forecast {
  std::vector<TangentPath> paths;
  Vec end, end_rate;  // c and ċ at the end
};

using MakeIntegrator = std::function<time::IntegratorPtr(const problem::DaeProblem&)>;

// From one snapshot to the next some hundred steps are usual. Models that need so many are trials
// with an effect far too strong.
inline constexpr int kMostTrialSteps = 1000;

// Advances the nodal field c from `begin` to `end`, with a path for each number of tangent steps.
// Throws std::runtime_error if that fails, or takes more steps.
Forecast forecast(const problem::CahnHilliard& problem, const MakeIntegrator& make_integrator,
                  VecView c, double begin, double end, const std::vector<int>& tangent_steps = {},
                  int most_steps = kMostTrialSteps);

}  // namespace traceraft::assimilation
