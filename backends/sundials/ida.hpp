// --integrator ida: SUNDIALS IDA, variable-order BDF for the DAE.
#pragma once

#include <memory>

#include "kernel/time/integrator.hpp"

namespace traceraft::sundials {

// The tolerance bounds the local error of c in each step, in L²(Γ_h) and relative to c:
// ‖error‖ ≤ rtol ‖c‖ + atol √|Γ|. Algebraic variables stay out of the test by default; with them it
// demands the same of μ.
//
// Every Newton correction solves with the exact Jacobian of the current iterate; when its factors
// are renewed is decided by the kernel's JacobianSolver, so IDA makes no set-ups of its own.
// Corrections keep the mass exactly, and so do IDA's predictors: linear combinations of states.
//
// Between the steps the solution is IDA's interpolant; the end of the run is met exactly.
time::IntegratorPtr make_ida(const problem::DaeProblem& problem,
                             const linear::LinearSolverChoice& solvers,
                             std::shared_ptr<const ThreadTeam> team,
                             const time::IntegratorSettings& settings);

}  // namespace traceraft::sundials
