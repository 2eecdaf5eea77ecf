#include "kernel/linear/linear_solver.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::linear {

LinearStatistics operator+(const LinearStatistics& a, const LinearStatistics& b) {
  return {a.setups + b.setups,
          a.solves + b.solves,
          a.iterations + b.iterations,
          std::max(a.most_iterations, b.most_iterations),
          a.setup_seconds + b.setup_seconds,
          a.solve_seconds + b.solve_seconds};
}

double scaled_norm(const BlockJacobian& J, VecView b) {
  const int n = J.block_size();
  const double scale = J.shift > 0 ? 1 / J.shift : 1.0;
  return std::sqrt(J.ranks().sum(scale * scale * fem::dot(b.head(n), b.head(n)) +
                                 fem::dot(b.tail(n), b.tail(n))));
}

Status judged_by_residual(const Status& said, const BlockJacobian& J, VecView b, VecView x,
                          double tolerance, const ThreadTeam& team) {
  constexpr double kSlack = 1.01;
  Vec residual(b.size());
  J.multiply(x, residual, team);
  residual = b - residual;
  // NaN is refused, too.
  if (scaled_norm(J, residual) <= kSlack * tolerance * scaled_norm(J, b)) return {};
  return said.ok() ? Status::retry("the residual is larger than the method says") : said;
}

void restore_mass(const BlockJacobian& J, VecView b, VecRef x) {
  const int n = J.block_size();
  const fem::SparsityPattern& pattern = *J.cc.pattern;
  Vec c_buffer, mu_buffer;
  const auto c = pattern.halo.with_ghosts(x.head(n), c_buffer);
  const auto mu = pattern.halo.with_ghosts(x.tail(n), mu_buffer);
  double held = 0, weight = 0, wanted = 0;
  for (int i = 0; i < n; ++i) {
    for (int k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k) {
      const int j = pattern.column[k];
      held += J.cc.values[k] * c[j] + J.cm.values[k] * mu[j];
      weight += J.cc.values[k];
    }
    wanted += b[i];
  }
  weight = J.ranks().sum(weight);
  if (weight == 0) return;
  x.head(n).array() += (J.ranks().sum(wanted) - J.ranks().sum(held)) / weight;
}

}  // namespace traceraft::linear
