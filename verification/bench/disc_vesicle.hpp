// A vesicle whose rafts are discs, as studies follow it.
#pragma once

#include <vector>

#include "kernel/discs/random_discs.hpp"
#include "kernel/observables/observables.hpp"
#include "verification/bench/bench.hpp"

namespace traceraft::bench {

// Its observables at the times (R²/D), which ascend. Throws std::runtime_error if it cannot be
// followed.
std::vector<observables::Observables> follow_discs(const Bench& bench,
                                                   const discs::DiscModel& model,
                                                   const discs::RandomDiscs& start,
                                                   double tolerance,
                                                   const std::vector<double>& times);

}  // namespace traceraft::bench
