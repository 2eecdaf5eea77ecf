// A diffuse boundary that is a circle: how it differs from a sharp one.
#pragma once

namespace traceraft::discs {

// In local equilibrium a round raft in the plane obeys, in lengths of δ = ε/√(2ρ),
//   c'' + c'/r = c (1 − c)(1 − 2c) − ν,   c'(0) = 0,   c → c_out far away,   ν = μ/(2ρ).
// These are its properties at the radius where c = ½, over those of a sharp boundary there.
struct RoundBoundary {
  double potential;  // ν over that of Gibbs and Thomson, 1/(6r)
  double held_mass;  // ∫ (c − c_out) less that of two uniform phases, over δ²
  double energy;  // ∫ f0 + ½ ε² |∇c|² less that of both phases, over that of a straight boundary
  double gradients;  // ∫ ε |∇c|² over that of a straight boundary
};

// At a radius in units of δ, and the derivative by it. The equation is solved by Newton's method on
// a grid once, from large radii to small ones; a table keeps what it gives. Beyond 20 δ, what the
// first three differ from their limits by falls like 1/r².
struct RoundBoundaryAt {
  RoundBoundary value, slope;
};
RoundBoundaryAt round_boundary(double radius);

}  // namespace traceraft::discs
