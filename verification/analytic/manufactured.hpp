// Manufactured solutions on curved surfaces, and the errors they show.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "verification/bench/bench.hpp"
#include "verification/bench/error_norms.hpp"

namespace traceraft::analytic {

// The derivatives of u = xyz at a point of the surface that manufactured problems need. On the unit
// sphere u is a spherical harmonic of degree 3: Δ_Γ u = −12 u.
struct SurfacePoint {
  double u, laplacian, bilaplacian;    // u, L = Δ_Γ u, Δ_Γ L
  Point gradient, laplacian_gradient;  // ∇_Γ u, ∇_Γ L
};

// The surfaces for which derivatives are known: "sphere", "ellipsoid", "torus" with their default
// parameters. Takes points near the surface to it. Throws std::logic_error for another.
using SurfaceFunction = std::function<SurfacePoint(const Point&)>;
SurfaceFunction surface_function(const std::string& surface);

// −Δ_Γ u + u = f with the matrices M, K and S of the program.
bench::ErrorNorms stationary_error(const fem::SurfaceSpace& space, const SurfaceFunction& u);

// The full system with c = ½ + ¼ cos(t) u and μ = f0'(c) − ε² Δ_Γ c, driven by the source that
// makes them a solution. `surface` is that of the space.
struct ManufacturedCahnHilliard {
  std::string surface;
  bench::ProblemPtr problem;

  ManufacturedCahnHilliard(const bench::Bench& bench, bench::SpacePtr space, std::string surface,
                           double epsilon);
  const fem::SurfaceSpace& space() const { return problem->space(); }
  bench::ExactFunction c(double t) const;
  bench::ExactFunction mu(double t) const;
  bench::StartState initial_state() const;  // nodal values of c(0), consistent μ
};

}  // namespace traceraft::analytic
