// The part of a background mesh that carries unknowns: the cut tetrahedra, their vertices (the
// nodes of the P1 space) and their edges. Vertices are points of one lattice; tetrahedra are those
// of its cells, all of one size, or larger ones.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/core/communicator.hpp"
#include "kernel/geometry/level_set.hpp"
#include "kernel/mesh/cube_mesh.hpp"
#include "kernel/mesh/refinement_forest.hpp"
#include "kernel/mesh/tet_shape.hpp"

namespace traceraft::mesh {

struct ActiveTet {
  std::array<int, 4> node;  // ascending in their lattice points
  std::array<int, 6> edge;  // in the order of kTetEdges
  int shape;                // number in ActiveMesh::shapes
};

struct ActiveEdge {
  int low, high;  // nodes; low is the smaller lattice point
};

// The part of one rank: every cut tetrahedron with a node that it owns, and so all that adds to the
// rows of its nodes. Nodes [0, owned_nodes) are owned and ascend in their global id, the ghosts of
// each neighbour follow. Tetrahedra and edges are in global order (by cell, by lower node), so sums
// over those at a node do not depend on how the mesh is distributed.
struct ActiveMesh {
  CubeMesh cube;
  std::vector<std::int64_t> node_id;  // global vertex id of each node
  std::vector<double> phi;            // level set at the nodes; never zero
  std::vector<TetShape> shapes;       // of the tetrahedra; the first six are those of a cell
  std::vector<ActiveTet> tets;
  std::vector<ActiveEdge> edges;  // ascending in the id of `low`
  int owned_nodes = 0;
  HaloPlan halo;

  bool uniform() const { return shapes.size() == 6; }
  int nodes() const { return static_cast<int>(node_id.size()); }
  bool owns(int node) const { return node < owned_nodes; }
  // A tetrahedron counts where its lowest node does, on one rank only.
  bool owns(const ActiveTet& tet) const { return owns(tet.node[0]); }
  const TetShape& shape(const ActiveTet& tet) const {
    return shapes[static_cast<std::size_t>(tet.shape)];
  }
  Point position(int node) const {
    return cube.position(cube.vertex(node_id[static_cast<std::size_t>(node)]));
  }
};

// Nodal values closer to zero than 1e-10 of the largest are moved to that distance, keeping their
// sign: Γ never passes exactly through a vertex, edge or face, no piece of it is counted twice, and
// its area changes by some 1e-10 of itself (relative to the steepest part of φ).
// Throws InputError (see find_cut_cells).
ActiveMesh build_active_mesh(const geometry::LevelSet& surface, std::int64_t cells,
                             const Communicator& ranks = kAlone);

// The same of the cut leaves of a forest of the surface, in their order; serial. Throws InputError
// if Γ_h is not closed, because the largest tetrahedra are too coarse for the surface.
ActiveMesh build_active_mesh(const geometry::LevelSet& surface, const RefinementForest& forest);

// For each tetrahedron the number of the same one, with the same φ, in an earlier mesh; −1: there
// is none. For meshes of forests on one lattice; on others it may find none.
std::vector<int> same_tetrahedra(const ActiveMesh& mesh, const ActiveMesh& earlier);

}  // namespace traceraft::mesh
