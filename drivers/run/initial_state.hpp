// What options say of the concentration that a run begins with.
#pragma once

#include "drivers/config/configuration.hpp"
#include "kernel/fem/surface_space.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft {

// c at the nodes of this rank, projected. Throws InputError, also for data of another kind of
// initial state than is asked for.
Vec initial_field(const Configuration& configuration, const CahnHilliardModel& model,
                  const SurfaceSpace& space);

}  // namespace traceraft
