// --integrator euler: the stabilised semi-implicit Euler scheme with Gomez–Hughes step control.
#pragma once

#include "kernel/time/integrator.hpp"

namespace traceraft::euler {

// Every step solves twice with the stabilised tangent, from two predictors y* (r = Δt/Δt_prev):
//   first order:   y* = y_n,                     σ = 1/Δt
//   second order:  y* = (1 + r) y_n − r y_{n−1},  σ = (1 + 2r)/((1 + r) Δt)     (BDF2)
//   J_stab(y*, σ) δ = −F(t + Δt, y*, ẏ*),   y = y* + δ.
// The error is e = ‖c₂ − c₁‖/‖c₂‖ in L²(Γ). The step is accepted if e ≤ tolerance, and
// Δt ← 0.9 √(tolerance/e) Δt (Gomez, Hughes, "Provably unconditionally stable, second-order
// time-accurate, mixed variational methods for phase-field models", J. Comput. Phys. 2011, and the
// adaptive step of Gomez, Calo, Bazilevs, Hughes, CMAME 2008).
//
// Where it differs from the reference code: a step at the smallest Δt whose error is too large ends
// the run instead of being accepted; Δt grows at most twofold, so that BDF2 stays zero-stable; the
// first step has an error estimate (half the difference to explicit Euler).
//
// kept_solution says which solution goes on: the second, as in the reference code; the first, whose
// energy never grows while |f0''| ≤ 2β; or "decaying", the second unless it would gain energy. It
// is the first where extrapolated states are unstable (DaeProblem::may_be_extrapolated).
//
// With large Δt the stabilisation holds both solutions back alike, which their difference does not
// show: at loose tolerances coarsening comes out late (docs/decisions/0006-keep-second.md).
//
// The two solves of a step do not depend on each other: with two threads they run at the same time,
// each on factors of its own or on those of both (LinearSolver::shares_factors). The result does
// not depend on the number of threads.
time::IntegratorPtr make_euler(const problem::DaeProblem& problem,
                               const linear::LinearSolverChoice& solvers,
                               std::shared_ptr<const ThreadTeam> team,
                               const time::IntegratorSettings& settings);

}  // namespace traceraft::euler
