// Are the rafts at rest? Then the data say nothing of how fast anything happens.
#pragma once

#include "kernel/problem/cahn_hilliard.hpp"
#include "verification/assimilation/filter/filter_problem.hpp"

namespace traceraft::assimilation {

// True if, between all snapshots of all vesicles, the values change by no more than noise and a
// rotation do, and if the base model forecasts that with a tenth of its D, with D and with ten
// times D alike. Rotations are allowed for on spheres. Serial; costs forecasts only where the
// values do not change.
bool are_at_rest(const FilterProblems& data, const problem::CahnHilliardModel& base);

}  // namespace traceraft::assimilation
