// The parts of the background mesh that the ranks own.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/geometry/level_set.hpp"
#include "kernel/mesh/cube_mesh.hpp"

namespace traceraft::mesh {

// The cube is cut into blocks, the blocks are lined up along a Hilbert curve, and the curve is cut
// into one interval per rank, of equal amounts of surface as a mesh of the blocks sees it. Every
// rank computes the same, from a few numbers and without asking another.
class Partition {
 public:
  // Everything belongs to rank 0.
  Partition() = default;
  // Throws InputError (see find_cut_cells).
  Partition(const geometry::LevelSet& surface, const CubeMesh& mesh, int ranks);

  int ranks() const { return static_cast<int>(first_.size()) + 1; }
  int owner(const Lattice& vertex) const;

  // Calls visit(rank), ascending, for every rank that owns a corner of the cell.
  template <class Visit>
  void for_each_owner(const Lattice& cell, const Visit& visit) const {
    if (first_.empty()) return visit(0);
    const int first = owner(cell);
    if (block(cell) == block(corner_of(cell, 7))) return visit(first);
    bool more = false;
    int owners[8];
    for (int corner = 0; corner < 8; ++corner) {
      owners[corner] = owner(corner_of(cell, corner));
      more |= owners[corner] != first;
    }
    if (!more) return visit(first);
    visit_each_once(owners, visit);
  }

 private:
  Lattice block(const Lattice& vertex) const;
  template <class Visit>
  static void visit_each_once(int (&owners)[8], const Visit& visit) {
    for (int last = -1;;) {
      int next = -1;
      for (const int owner : owners)
        if (owner > last && (next < 0 || owner < next)) next = owner;
      if (next < 0) return;
      visit(next);
      last = next;
    }
  }

  std::int64_t cells_ = 1, blocks_ = 1;
  std::vector<std::uint64_t> first_;  // where on the curve ranks 1, 2, … begin
};

// Position on the Hilbert curve through a cube of 2^bits points per edge (Skilling, AIP Conf. Proc.
// 707, 381, 2004): neighbours on the curve are neighbours in space.
std::uint64_t hilbert_position(Lattice point, int bits);

}  // namespace traceraft::mesh
