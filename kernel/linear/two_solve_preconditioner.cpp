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
  if (J.tangent == Tangent::exact) return setup_exact(J, mobility, team);
  const TwoSolveShifts shifts = two_solve_shifts(J.shift, mobility, J.stiffness, J.curvature);
  p_ = shifts.p;
  q_ = shifts.q;
  return factorise(J, team);
}

Status TwoSolvePreconditioner::setup_exact(const BlockJacobian& J, double mobility,
                                           const ThreadTeam& team) {
  // A state inside the spinodal has a very negative f0''; a shift above its size always suffices.
  constexpr int kMostShifts = 12;
  double s = 1.5 * std::sqrt(J.stiffness * J.shift / mobility);
  Status status;
  for (int attempt = 0; attempt < kMostShifts; ++attempt, s *= 2) {
    p_ = 2 * J.shift / (J.curvature + s);
    q_ = -s;
    status = factorise(J, team);
    if (status.ok()) break;
  }
  return status;
}

Status TwoSolvePreconditioner::factorise(const BlockJacobian& J, const ThreadTeam& team) {
  Status status[2];
  team.run([&](int part) {
    for (int which = part; which < 2; which += team.size())
      status[which] = which == 0 ? first_->factorise(combine(1, J.cm, p_, J.mm))
                                 : second_->factorise(combine(-1, J.mc, -q_, J.mm));
  });
  return status[0].ok() ? status[1] : status[0];
}

void TwoSolvePreconditioner::apply(const BlockJacobian& J, ConstVec r, VecRef z,
                                   const ThreadTeam& team, int lane) {
  const int n = J.block_size();
  auto& [right, v] = work_[lane];
  v.resize(n);
  right = r.head(n) + p_ * r.tail(n);
  first_->solve(right, v, team, lane);
  J.mm.multiply(v, right, team);
  right -= r.tail(n);
  second_->solve(right, z.head(n), team, lane);
  z.tail(n) = v + q_ * z.head(n);
}

}  // namespace traceraft
