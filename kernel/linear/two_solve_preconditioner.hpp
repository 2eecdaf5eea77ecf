// The block preconditioner at the core of every iterative backend.
#pragma once

#include <memory>
#include <vector>

#include "kernel/linear/krylov.hpp"

namespace traceraft {

// The Schur complement of [σM A; −B M] is a polynomial in M⁻¹A and M⁻¹B. With A ≈ m K and
// B ≈ ε² K + β M (m: mean mobility) it factorises: take r₁ ≤ r₂, the roots of
//   m ε² r² − m β r + σ = 0        (if complex, both √(σ/(m ε²))),
// p = m r₁ and q = β − ε² r₂. Then two solves with symmetric positive definite n×n matrices,
//   (A + p M) v = R₁ + p R₂,   (B − q M) δc = M v − R₂,   δμ = v + q δc,
// invert J exactly for constant mobility and real roots, and are close to it otherwise: 2–12
// GMRES iterations over Δt = 1e-5…1e3 and h = 1/10…1/40.
class TwoSolvePreconditioner {
 public:
  TwoSolvePreconditioner(const SpdSolverFactory& make_solver, int lanes)
      : first_(make_solver(lanes)), second_(make_solver(lanes)), work_(lanes) {}

  // Either tangent: A is the cm block, and B enters through ε² (K + ρS) and the scalar β =
  // curvature only, B − q M = ε² (K + ρS) + ε² r₂ M, so both matrices are positive definite
  // whatever the state. The two factorisations run concurrently if the team has two threads.
  Status setup(const BlockJacobian& J, const ThreadTeam& team);

  // z ≈ J⁻¹ r, with M taken from `J`. Lanes may be used at the same time.
  void apply(const BlockJacobian& J, ConstVec r, VecRef z, const ThreadTeam& team, int lane);

 private:
  SpdSolverPtr first_, second_;
  double p_ = 0, q_ = 0;
  struct Work {
    Vec right, v;
  };
  std::vector<Work> work_;  // per lane
};

struct TwoSolveShifts {
  double p, q;
};
TwoSolveShifts two_solve_shifts(double sigma, double mobility, double stiffness, double curvature);

}  // namespace traceraft
