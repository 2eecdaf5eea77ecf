// --integrator rosenbrock: a linearly implicit Runge–Kutta method of order 3.
#pragma once

#include "kernel/time/integrator.hpp"

namespace traceraft::rosenbrock {

// ROS34PW2 of Rang and Angermann ("New Rosenbrock W-methods of order 3 for partial differential
// algebraic equations of index 1", BIT 45, 2005): four stages, stiffly accurate, L-stable, embedded
// method of order 2. For F(t, y, ẏ) = M ẏ − f(t, y) each stage solves
//   J(σ = 1/(γΔt)) u_i = −F(t_n + α_i Δt, y_n + Σ a_ij u_j, −Σ c_ij u_j / Δt) − γ_i Δt ∂F/∂t
// with the exact tangent at the beginning of the step: no Newton iteration, one Jacobian per step.
//
// The tolerance bounds the embedded error of c, ‖c − ĉ‖/‖c‖ in L²(Γ); Δt ← 0.9 (tolerance/e)^(1/3)
// Δt.
time::IntegratorPtr make_rosenbrock(const problem::DaeProblem& problem,
                                    const linear::LinearSolverChoice& solvers,
                                    std::shared_ptr<const ThreadTeam> team,
                                    const time::IntegratorSettings& settings);

}  // namespace traceraft::rosenbrock
