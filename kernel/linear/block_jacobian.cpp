#include "kernel/linear/block_jacobian.hpp"

namespace traceraft::linear {

void BlockJacobian::multiply(VecView x, VecRef y, const ThreadTeam& team) const {
  const fem::SparsityPattern& p = *cc.pattern;
  const int n = p.rows();
  Vec c_buffer, mu_buffer;
  const auto c = p.halo.with_ghosts(x.head(n), c_buffer);
  const auto mu = p.halo.with_ghosts(x.tail(n), mu_buffer);
  team.for_range(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double first = 0, second = 0;
      for (int k = p.row_begin[i]; k < p.row_begin[i + 1]; ++k) {
        const int j = p.column[k];
        first += cc.values[k] * c[j] + cm.values[k] * mu[j];
        second += mc.values[k] * c[j] + mm.values[k] * mu[j];
      }
      y[i] = first;
      y[n + i] = second;
    }
  });
}

}  // namespace traceraft::linear
