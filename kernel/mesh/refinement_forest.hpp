// Tetrahedra of different size near one surface: those of a coarse Kuhn mesh, bisected again and
// again (Maubach, SIAM J. Sci. Comput. 16, 210, 1995).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/geometry/level_set.hpp"
#include "kernel/mesh/cube_mesh.hpp"

namespace traceraft::mesh {

// How fine tetrahedra can be. A tetrahedron of generation g has been bisected g times; three
// generations halve its size.
struct RefinementLevels {
  std::int64_t cells;  // per edge of the box, were all as small as the smallest; a multiple of
  int levels;          // 2^levels: the largest are 2^levels as large as the smallest

  int finest_generation() const { return 3 * levels; }
  std::int64_t coarsest_cells() const { return cells >> levels; }
  CubeMesh lattice() const { return {cells}; }  // all vertices are points of it
};

// Throws InputError if the cells cannot be halved so often, or the levels are none or too many.
void require_levels(const RefinementLevels& levels);

// A value: what is coarsened is built anew from its roots. Only tetrahedra that Γ may enter are
// kept, however they are bisected, so that time and memory grow like the surface, not the box.
//
// Kept leaves are conforming: a leaf with a vertex in the middle of one of its edges is bisected,
// by the edge that is its turn, until there is none. All tetrahedra around a cut edge are kept, and
// every one sees the vertices of the others there, so Γ_h is closed.
class RefinementForest {
 public:
  // All leaves near the surface have one generation, but for those of the closure.
  RefinementForest(const geometry::LevelSet& surface, const RefinementLevels& levels,
                   int generation);

  // The same surface with other generations: of each leaf of this forest (leaf_cells) the least
  // that is wanted in its place. Closure adds to them.
  RefinementForest refined(const geometry::LevelSet& surface,
                           const std::vector<int>& wanted_generation) const;

  struct Vertex {
    Lattice at;
    double phi;
  };
  struct Cell {
    std::array<int, 4> vertex;  // in the order that bisection needs
    int root;                   // that it is a part of
    int child = -1;             // children are child and child + 1; −1: a leaf
    std::int8_t generation;
    std::int8_t turn;   // the edge from vertex 0 to vertex `turn` is bisected next
    bool cut = false;   // does φ change its sign between the vertices?
    bool near = false;  // may Γ enter it?
    bool leaf() const { return child < 0; }
  };

  const RefinementLevels& levels() const { return levels_; }
  const std::vector<Vertex>& vertices() const { return vertices_; }
  const std::vector<Cell>& cells() const { return cells_; }
  // Numbers of the leaves that Γ_h cuts, in the order of the lattice points of their vertices.
  const std::vector<int>& leaf_cells() const { return leaf_cells_; }
  std::vector<int> leaf_generations() const;

  // Is a cell bisected? One bit for each near cell, depth first from root to root.
  std::vector<bool> bits() const;
  // Throws IoError if the bits are not those of a forest of this surface.
  RefinementForest(const geometry::LevelSet& surface, const RefinementLevels& levels,
                   const std::vector<bool>& bits);

 private:
  class Builder;
  RefinementForest() = default;

  RefinementLevels levels_{};
  std::vector<Vertex> vertices_;
  std::vector<Cell> cells_;   // roots first, children after their parents
  std::vector<double> bend_;  // of φ in each root: a bound of its second derivative
  std::vector<int> leaf_cells_;
};

}  // namespace traceraft::mesh
