// The background mesh: the cube [−5/3, 5/3]³ cut into n³ cells of six Kuhn tetrahedra each. Nothing
// of it is stored; vertices and cells are numbered x fastest.
#pragma once

#include <array>
#include <cstdint>

#include "kernel/geometry/level_set.hpp"

namespace traceraft::mesh {

using geometry::kBoxHalfWidth;

using Lattice = std::array<std::int64_t, 3>;  // integer coordinates of a vertex or a cell

// Kuhn tetrahedron k has the vertices 0, e_p0, e_p0 + e_p1, (1,1,1) of its cell for permutation p.
inline constexpr std::array<std::array<int, 3>, 6> kKuhnPermutations = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

// Corner masks (bit d set: offset by one along axis d) of the four vertices of each tetrahedron.
inline constexpr std::array<std::array<int, 4>, 6> kKuhnCorners = {
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

// The six edges of a tetrahedron as pairs of local vertices. Kuhn vertices are ordered, so the
// first is the smaller lattice point.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

struct CubeMesh {
  std::int64_t cells;  // per edge of the cube

  double h() const { return 2 * kBoxHalfWidth / static_cast<double>(cells); }

  std::int64_t vertex_id(const Lattice& v) const {
    return v[0] + (cells + 1) * (v[1] + (cells + 1) * v[2]);
  }
  Lattice vertex(std::int64_t id) const {
    return {id % (cells + 1), id / (cells + 1) % (cells + 1), id / (cells + 1) / (cells + 1)};
  }
  std::int64_t cell_id(const Lattice& c) const { return c[0] + cells * (c[1] + cells * c[2]); }
  Lattice cell(std::int64_t id) const {
    return {id % cells, id / cells % cells, id / cells / cells};
  }
  // The same lattice point has bitwise the same coordinates wherever it is asked for.
  Point position(const Lattice& v) const {
    const auto along = [&](std::int64_t i) {
      return kBoxHalfWidth * (static_cast<double>(2 * i - cells) / static_cast<double>(cells));
    };
    return {along(v[0]), along(v[1]), along(v[2])};
  }
};

inline Lattice corner_of(const Lattice& cell, int corner) {
  return {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
}

}  // namespace traceraft::mesh
