// The block preconditioner at the core of every iterative backend.
#pragma once

#include <memory>
#include <vector>

#include "kernel/linear/krylov.hpp"

namespace traceraft::linear {

// The Schur complement of [σM A; −B M] is a polynomial in M⁻¹A and M⁻¹B. With A ≈ m K and
// B ≈ ε² K + β M (m: mean mobility) it factorises: take r₁ ≤ r₂, the roots of
//   m ε² r² − m β r + σ = 0        (if complex, both √(σ/(m ε²)) with a smaller m, see the source),
// p = m r₁ and q = β − ε² r₂. Then two solves with symmetric positive definite n×n matrices,
//   (A + p M) v = R₁ + p R₂,   (B − q M) δc = M v − R₂,   δμ = v + q δc,
// invert J exactly for constant mobility and real roots, and are close to it otherwise: 2–12
// GMRES iterations over Δt = 1e-5…1e3 and h = 1/10…1/40.
//
// With the exact tangent B = ε² K + (f0'') is nearly singular on shifts of the phase boundaries,
// which no constant β is right for: there the second matrix is B itself plus a shift s M, that is
// q = −s, just large enough to be positive definite, s = 1.5 ε √(σ/m), and p = 2σ/(β + s). The
// spectrum is then bounded on the boundaries, where A is large and S ≈ A M⁻¹ (B + σ M A⁻¹ M), as
// well as in the phases, where it is small and S ≈ σ M. The factors 1.5 and 2 were measured, see
// docs/decisions/0009-exact-tangent-preconditioner.md.
struct TwoSolveShifts {
  double p = 0, q = 0;
};
// From the roots, for the stabilised tangent.
TwoSolveShifts two_solve_shifts(double sigma, double mobility, double stiffness, double curvature);
// For a Jacobian. With the exact tangent every further attempt doubles s, as a state inside the
// spinodal has a very negative f0''; after kMostShifts attempts the second matrix is surely
// positive definite. With the stabilised one there is one attempt, 0.
inline constexpr int kMostShifts = 12;
TwoSolveShifts two_solve_shifts(const BlockJacobian& J, int attempt = 0);

class TwoSolvePreconditioner {
 public:
  TwoSolvePreconditioner(const SpdSolverFactory& make_solver, int lanes)
      : first_(make_solver(lanes)), second_(make_solver(lanes)), work_(lanes) {}

  // The two factorisations run concurrently if the team has two threads. retry: no shift makes the
  // second matrix positive definite.
  Status setup(const BlockJacobian& J, const ThreadTeam& team);

  // z ≈ J⁻¹ r, with M taken from `J`. Lanes may be used at the same time.
  void apply(const BlockJacobian& J, VecView r, VecRef z, const ThreadTeam& team, int lane);

 private:
  Status factorise(const BlockJacobian& J, const ThreadTeam& team);  // with p_ and q_

  SpdSolverPtr first_, second_;
  TwoSolveShifts shifts_;
  struct Work {
    Vec right, v;
  };
  std::vector<Work> work_;  // per lane
};

}  // namespace traceraft::linear
