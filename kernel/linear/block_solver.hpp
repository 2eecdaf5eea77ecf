// --linear-solver block: a Krylov method with the two-solve preconditioner.
#pragma once

#include <memory>

#include "kernel/linear/krylov.hpp"

namespace traceraft::linear {

// All lanes share the factors. Old factors are kept as long as the iterations they cost extra stay
// below the price of new ones.
LinearSolverPtr make_block_solver(const SpdSolverFactory& make_spd_solver,
                                  const KrylovFactory& make_krylov,
                                  std::shared_ptr<const ThreadTeam> team, int lanes);

}  // namespace traceraft::linear
