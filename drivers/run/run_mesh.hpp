// The mesh of a run, as options say it: uniform, or one that follows the boundaries.
#pragma once

#include "drivers/config/configuration.hpp"
#include "kernel/mesh/refinement_forest.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::run {

// The options of a new run or ensemble. A case whose mesh would follow the boundaries has a uniform
// one where none can follow: on several ranks, with noise in every cell, and on surfaces that large
// cells do not hold.
config::Configuration run_configuration(config::GivenValues file, const config::GivenValues& flags);

// Throws InputError if the mesh is to follow the boundaries, for commands whose meshes are equal.
void refuse_adaptive_mesh(const config::Configuration& configuration);

// Is the mesh to follow the boundaries? Throws InputError for a word that is no mesh, and where no
// mesh can follow.
bool is_adaptive(const config::Configuration& configuration,
                 const problem::CahnHilliardModel& physics, const Communicator& ranks);

// Are all cells as small as the smallest at the beginning?
bool begins_finest(const config::Configuration& configuration);

// --mesh-levels, or the most that change the area by less than 1e-5. Throws InputError.
mesh::RefinementLevels refinement_levels(const config::Configuration& configuration,
                                         const geometry::LevelSet& surface);

}  // namespace traceraft::run
