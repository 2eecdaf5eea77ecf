// Transport by an incompressible flow u = n × ∇ψ in the surface, in the form of one trilinear
// integral,
//   T(c, ψ, v) = ∫ c n·(∇ψ × ∇v) = ∫ c u·∇v,
// which is antisymmetric in ψ and v. With the capillary force A T(c, μ, ·) of the same form the
// energy that the flow takes is exactly the power of its friction.
#pragma once

#include <vector>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::flow {

// ∫_T n·(∇λ_i × ∇λ_j) of an element, of the pairs of kTetEdges: it does not depend on how the
// triangles are lifted, as dψ ∧ dv needs no metric.
using ElementCurl = std::array<double, 6>;
std::vector<ElementCurl> element_curls(const fem::SurfaceSpace& space);

// r_i += factor T(c, ψ, φ_i), with c constant on each element, its mean there. c and ψ have ghosts.
// Rows sum to zero, and a constant c is not moved, both exactly but for roundoff.
void add_transport(const fem::SurfaceSpace& space, const std::vector<ElementCurl>& curls,
                   double factor, VecView c, VecView psi, VecRef r);

// matrix_ij += factor T(φ_j, ψ, φ_i): the derivative of the above by c.
void add_transport_matrix(const fem::SurfaceSpace& space, const std::vector<ElementCurl>& curls,
                          double factor, VecView psi, fem::CsrMatrix& matrix);

}  // namespace traceraft::flow
