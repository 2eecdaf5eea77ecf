// The concentration that a run begins with, as options say it.
#pragma once

#include <functional>

#include "drivers/config/configuration.hpp"
#include "kernel/discs/random_discs.hpp"
#include "kernel/fem/surface_space.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::run {

// c at the nodes of this rank, projected, on any mesh. Both throw InputError: for data of another
// kind of initial state than is asked for, and for what no mesh or not this one can have.
using FieldOnAnyMesh = std::function<Vec(const fem::SurfaceSpace&)>;
FieldOnAnyMesh initial_field(const config::Configuration& configuration,
                             const problem::CahnHilliardModel& model);

// Is it the same field on any mesh, but for errors of the mesh? Noise is not.
bool is_given_on_any_mesh(const config::Configuration& configuration);

// The rafts that a run of discs begins with: `caps` or `discs`. Throws InputError, also for others.
discs::StartingDiscs initial_discs(const config::Configuration& configuration,
                                   const problem::CahnHilliardModel& model);

}  // namespace traceraft::run
