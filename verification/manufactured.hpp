// Manufactured solutions on the unit sphere and the errors they show.
#pragma once

#include <memory>
#include <vector>

#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/time/integrator.hpp"
#include "verification/error_norms.hpp"

namespace traceraft {

// Y = xyz/|x|³, a spherical harmonic of degree 3: −Δ_Γ Y = 12 Y.
ExactFunction harmonic_three();
inline constexpr double kHarmonicEigenvalue = 12;

// −Δ_Γ u + u = 13 Y with the matrices M, K and S of the program: u = Y.
ErrorNorms stationary_error(const SurfaceSpace& space);

// The full system with c = ½ + ¼ cos(t) Y and μ = f0'(c) + 12 ε² (c − ½), driven by the source that
// makes them a solution.
struct ManufacturedCahnHilliard {
  std::shared_ptr<const SurfaceSpace> space;
  std::unique_ptr<CahnHilliard> problem;

  ManufacturedCahnHilliard(std::shared_ptr<const SurfaceSpace> space, double epsilon);
  ExactFunction c(double t) const;
  ExactFunction mu(double t) const;
  Vec initial_state(Vec& ydot) const;  // nodal values of c(0), consistent μ
};

// Runs with equal steps from 0 to t_end; returns y(t_end).
Vec run_with_equal_steps(const ManufacturedCahnHilliard& problem, Integrator& integrator,
                         double t_end);

}  // namespace traceraft
