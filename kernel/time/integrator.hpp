// The interface of every time integrator, whatever library it comes from.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/linear/linear_solver.hpp"
#include "kernel/problem/dae_problem.hpp"

namespace traceraft::time {

struct IntegratorSettings {
  double tolerance = 5e-3;      // relative, in L²(Γ): each method documents what it bounds
  double initial_step = 0;      // 0: chosen from the initial state
  double min_step = 0;          // below it: fatal "no step size"; 0: 1e-14 of the time span
  double max_step = 0;          // 0: unbounded
  double linear_tolerance = 0;  // relative residual of each correction; 0: the method's choice
  std::string kept_solution = "second";  // euler: which of its pair goes on
  bool reject_energy_rises = false;      // of a model that can only lose energy
  std::map<std::string, double>
      method_options;  // options of one method only, by its names for them

  double linear_tolerance_or(double choice) const {
    return linear_tolerance > 0 ? linear_tolerance : choice;
  }
};

struct IntegratorStatistics {
  long steps = 0;         // accepted
  long rejected = 0;      // error too large
  long first_order = 0;   // accepted with the first-order solution, so that energy falls
  long failures = 0;      // a solve or an evaluation failed and the step was retried
  long energy_rises = 0;  // of the failures, those because the energy grew
  long residuals = 0;
  long jacobians = 0;
  long newton_iterations = 0;   // 0 for methods that need none
  int order = 0;                // of the last step
  long renewals = 0;            // factors renewed because a solve with old ones failed
  long fallbacks = 0;           // solves left to the fallback solver
  double assembly_seconds = 0;  // residuals and Jacobians
};

// Contract
// - start(t0, y0, ẏ0, t_end): a consistent state; nothing else may have been called before.
// - advance() takes one accepted step, never beyond t_end. ok: time() has grown. fatal: why says
//   what failed and the state is still the last accepted one. retry is never returned.
// - interpolate(t) gives the solution anywhere in the last step, [time() − step(), time()], to the
//   order of the method and with the mass of the steps; asking does not change the run.
// - save writes everything advance() depends on. An integrator that loads it (after being built
//   with the same problem and settings) continues bitwise like the one that saved.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string name() const = 0;
  virtual Status start(double t0, VecView y0, VecView ydot0, double t_end) = 0;
  virtual Status advance() = 0;
  virtual Status interpolate(double t, VecRef y) const = 0;

  virtual double time() const = 0;
  virtual double step() const = 0;       // size of the last accepted step
  virtual double next_step() const = 0;  // proposed for the next one
  virtual const Vec& state() const = 0;  // y at time()
  // Does the scheme promise that the energy of a dissipative model does not grow in this step?
  virtual bool promises_energy_decay() const = 0;

  virtual IntegratorStatistics statistics() const = 0;
  virtual linear::LinearStatistics linear_statistics() const = 0;
  virtual void save(CheckpointOut out) const = 0;
  virtual void load(CheckpointIn in) = 0;  // throws IoError if the data are not its own
};

using IntegratorPtr = std::unique_ptr<Integrator>;

}  // namespace traceraft::time
