// The Jacobian ∂F/∂y + σ ∂F/∂ẏ of the surface Cahn–Hilliard DAE in its 2×2 block structure.
#pragma once

#include "kernel/fem/csr.hpp"

namespace traceraft::linear {

enum class Tangent {
  exact,      // the derivative of the residual
  stabilised  // mobility frozen, f0'' replaced by a constant β: symmetric blocks. One Newton step
              // from a predictor with it is the semi-implicit stabilised Euler step
};

// Acts on (δc, δμ), each of length n:   [ cc  cm ] [δc]
//                                       [ mc  mm ] [δμ]
// cc = σ M̃ (+ mobility derivative), cm = K_M + ρ S =: A, mc = −(b' + ε² (K + ρ S)) =: −B, mm = M̃.
struct BlockJacobian {
  explicit BlockJacobian(const fem::PatternPtr& pattern)
      : cc(pattern), cm(pattern), mc(pattern), mm(pattern) {}

  fem::CsrMatrix cc, cm, mc, mm;
  double shift = 0;  // σ
  Tangent tangent = Tangent::exact;

  // The scales from which preconditioners choose their shifts: A ≈ mobility · K and
  // B ≈ stiffness · K + curvature · M̃.
  double mobility = 0;   // mean of M(c_h): trace(K_M) / trace(K)
  double stiffness = 0;  // ε²
  double curvature = 0;  // β, or the mean of max(f0'', 0) for the exact tangent

  int block_size() const { return cc.pattern->rows(); }
  const Communicator& ranks() const { return *cc.pattern->halo.ranks; }

  // y = J x; collective
  void multiply(VecView x, VecRef y, const ThreadTeam& team) const;
};

}  // namespace traceraft::linear
