// The interface between a time integrator and a linear solver.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/core/status.hpp"
#include "kernel/core/thread_team.hpp"
#include "kernel/core/types.hpp"
#include "kernel/linear/block_jacobian.hpp"

namespace traceraft::linear {

struct SolveReport {
  Status status;
  int iterations = 0;
};

struct LinearStatistics {
  long setups = 0;
  long solves = 0;
  long iterations = 0;
  int most_iterations = 0;
  double setup_seconds = 0;
  double solve_seconds = 0;
};
LinearStatistics operator+(const LinearStatistics& a, const LinearStatistics& b);

// Contract
// - A solver has lanes: systems of one pattern that may be solved at the same time from different
//   threads. Factors of one set-up serve either all lanes or the lane they were made for.
// - setup(J, lane) prepares (factorises) for J; may be called any number of times. With shared
//   factors it is never called while another lane solves.
// - solve(J, b, x, tolerance, lane) solves J x = b for the J of the last set-up, or a later one of
//   the same pattern if wants_setup(J, lane) is false. x comes in as the initial guess. On ok
//   ‖D (b − J x)‖₂ ≤ tolerance ‖D b‖₂ with D scaling the first block row by 1/σ, and the sum of the
//   first block row holds to roundoff, so mass is exact whatever the tolerance. Otherwise x is
//   unspecified and the status says why; a wrong x is never reported as ok.
// - wants_setup(J, lane) depends on what was passed in and on counts, never on time, so that a
//   repeated run decides alike; save and load carry those counts over a restart.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual std::string name() const = 0;
  virtual bool shares_factors() const = 0;
  virtual Status setup(const BlockJacobian& J, int lane = 0) = 0;
  virtual bool wants_setup(const BlockJacobian& J, int lane = 0) const = 0;
  virtual SolveReport solve(const BlockJacobian& J, VecView b, VecRef x, double tolerance,
                            int lane = 0) = 0;
  virtual LinearStatistics statistics() const = 0;
  virtual void save(CheckpointOut out) const = 0;
  virtual void load(CheckpointIn in) = 0;
};

using LinearSolverPtr = std::unique_ptr<LinearSolver>;
using LinearSolverFactory = std::function<LinearSolverPtr(int lanes)>;

// How an integrator gets its solvers: the one asked for and, possibly empty, the one to fall back
// on.
struct LinearSolverChoice {
  LinearSolverFactory primary;
  LinearSolverFactory fallback;
};

// D of the contract: the first block row is divided by the shift so that one norm judges both.
double scaled_norm(const BlockJacobian& J, VecView b);

// The explicit residual b − J x of the last iterate decides, not what an iterative method says of
// it. The status is ok if the residual is as small as the contract says, up to rounding. Otherwise
// it is what the method said, or that it was mistaken. Collective.
Status judged_by_residual(const Status& said, const BlockJacobian& J, VecView b, VecView x,
                          double tolerance, const ThreadTeam& team);

// Shifts the differential half of x by a constant so that 1ᵀ(cc δc + cm δμ) = 1ᵀb₁ exactly. The
// stiffness terms drop out of that sum, so it is the mass balance of the step.
void restore_mass(const BlockJacobian& J, VecView b, VecRef x);

}  // namespace traceraft::linear
