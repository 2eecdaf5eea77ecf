// Does a level set have a gradient on its surface, as its contract says?
#pragma once

#include "kernel/geometry/level_set.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::mesh {

// |∇φ| at a point of Γ over that across a cell around it: 1 where φ is nearly linear on the scale
// of the mesh, 0 where the gradient vanishes (a cube of a distance), large where φ jumps.
double relative_gradient(const geometry::LevelSet& surface, const Point& on_surface, double h);

// Cuts are found by linear interpolation, which needs both to be alike. Throws InputError naming a
// place if they differ by a factor of 10 or more at a larger share than this of some hundred points
// on each rank. Collective.
void require_gradient(const geometry::LevelSet& surface, const ActiveMesh& mesh,
                      const CutSurface& cut, double share, const Communicator& ranks = kAlone);

}  // namespace traceraft::mesh
