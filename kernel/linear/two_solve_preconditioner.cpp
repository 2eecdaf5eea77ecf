#include "kernel/linear/two_solve_preconditioner.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft {

TwoSolveShifts two_solve_shifts(double sigma, double mobility, double stiffness, double curvature) {
  const double ratio = sigma / (mobility * stiffness);  // r₁ r₂
  const double half_sum = curvature / (2 * stiffness);  // (r₁ + r₂) / 2
  const double discriminant = half_sum * half_sum - ratio;
  double r1 = std::sqrt(ratio), r2 = r1;
  if (discriminant >= 0) {
    r2 = half_sum + std::sqrt(discriminant);
    r1 = ratio / r2;  // without cancellation
  }
  return {mobility * r1, curvature - stiffness * r2};
}

Status TwoSolvePreconditioner::setup(const BlockJacobian& J, const ThreadTeam& team) {
  // The mean mobility of a nearly pure state tends to zero; its floor keeps the shifts finite.
  const double mobility = std::max(J.mobility, 1e-8);
  const TwoSolveShifts shifts = two_solve_shifts(J.shift, mobility, J.stiffness, J.curvature);
  p_ = shifts.p;
  q_ = shifts.q;
  Status status[2];
  const auto factorise = [&](int which) {
    status[which] = which == 0 ? first_->factorise(combine(1, J.cm, p_, J.mm))
                               : second_->factorise(combine(-1, J.mc, -q_, J.mm));
  };
  team.run([&](int part) {
    for (int which = part; which < 2; which += team.size()) factorise(which);
  });
  return status[0].ok() ? status[1] : status[0];
}

void TwoSolvePreconditioner::apply(const BlockJacobian& J, ConstVec r, VecRef z,
                                   const ThreadTeam& team) {
  const int n = J.block_size();
  v_.resize(n);
  right_ = r.head(n) + p_ * r.tail(n);
  first_->solve(right_, v_);
  J.mm.multiply(v_, right_, team);
  right_ -= r.tail(n);
  second_->solve(right_, z.head(n));
  z.tail(n) = v_ + q_ * z.head(n);
}

}  // namespace traceraft
