// The mesh that a run begins on: uniform, or fine along the boundaries of its initial state.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "kernel/fem/refinement_rule.hpp"
#include "kernel/mesh/refinement_forest.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::run {

// Is the mesh to follow the boundaries? Throws InputError for a word that is no mesh, and where no
// mesh can follow.
bool is_adaptive(const config::Configuration& configuration,
                 const problem::CahnHilliardModel& physics, const Communicator& ranks);

// Are all cells as small as the smallest at the beginning?
bool begins_finest(const config::Configuration& configuration);

// --mesh-levels, or the most that change the area by less than 1e-5. Throws InputError.
mesh::RefinementLevels refinement_levels(const config::Configuration& configuration,
                                         const geometry::LevelSet& surface);

fem::RefinementRule refinement_rule(const config::Configuration& configuration,
                                    const mesh::RefinementLevels& levels);

using SpacePtr = std::shared_ptr<const fem::SurfaceSpace>;
using MakeSpace = std::function<SpacePtr(mesh::ActiveMesh)>;

// A field, and a mesh that is as fine as it needs.
struct FieldOnMesh {
  mesh::RefinementForest forest;
  SpacePtr space;
  Vec field;
};

// From a moderate mesh, which is refined and coarsened until it fits the field that make_field
// gives on it.
FieldOnMesh adapted_field(const geometry::LevelSet& surface, const mesh::RefinementLevels& levels,
                          const fem::RefinementRule& rule,
                          const problem::CahnHilliardModel& physics, const MakeSpace& make_space,
                          const std::function<Vec(const fem::SurfaceSpace&)>& make_field);

}  // namespace traceraft::run
