// Finds the cells that the surface passes through without visiting the cube.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/core/communicator.hpp"
#include "kernel/geometry/level_set.hpp"
#include "kernel/mesh/cube_mesh.hpp"
#include "kernel/mesh/partition.hpp"

namespace traceraft::mesh {

// Ids of the cells of this rank, those with a corner that it owns, whose corners differ in the sign
// of φ (φ = 0 counts as positive), ascending.
//
// Every component of the piecewise-linear surface leaves a cell through faces whose corners differ
// in sign, so a walk over such faces from one cell per component finds exactly the cut cells: time
// and memory grow like n². The walk starts from sign changes on a lattice of at most 64 intervals
// per edge; a component that fits between its points is not seen. Ranks walk their own cells and
// tell each other where a walk leaves them.
//
// Throws InputError if φ is not finite, has one sign on the lattice, or Γ reaches the box.
std::vector<std::int64_t> find_cut_cells(const geometry::LevelSet& surface, const CubeMesh& mesh,
                                         const Partition& partition = {},
                                         const Communicator& ranks = kAlone);

}  // namespace traceraft::mesh
