#include "kernel/mesh/partition.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kernel/core/error.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::mesh {
namespace {

constexpr int kBits = 16;  // of the curve, per direction

// Enough blocks for even shares, about a hundred a rank: the surface meets some 2 blocks² of them.
std::int64_t block_count(std::int64_t cells, int ranks) {
  const auto wanted = static_cast<std::int64_t>(std::ceil(7 * std::sqrt(ranks)));
  return std::min({cells, std::max(std::int64_t{64}, wanted), std::int64_t{1} << kBits});
}

// How many triangles of Γ_h a fine mesh makes of a piece of surface: twice as many as points, of
// which the edges of direction d give |n·d| per area h².
double share(const ActiveMesh& coarse, const CutSurface& surface, std::size_t triangle) {
  const Point normal = cut_normal(coarse, coarse.tets[surface.triangle_tet[triangle]]);
  double points = 0;
  for (int direction = 1; direction < 8; ++direction)
    points += std::fabs(normal.dot(Point(direction & 1, direction >> 1 & 1, direction >> 2)));
  return surface.triangle_area[triangle] * points;
}

}  // namespace

std::uint64_t hilbert_position(Lattice point, int bits) {
  // From coordinates to the "transposed" position, in place: undo the rotations, then Gray code.
  const std::int64_t top = std::int64_t{1} << (bits - 1);
  for (std::int64_t q = top; q > 1; q >>= 1) {
    const std::int64_t below = q - 1;
    for (std::int64_t& x : point) {
      if (x & q) {
        point[0] ^= below;
      } else {
        const std::int64_t swapped = (point[0] ^ x) & below;
        point[0] ^= swapped;
        x ^= swapped;
      }
    }
  }
  point[1] ^= point[0];
  point[2] ^= point[1];
  std::int64_t flipped = 0;
  for (std::int64_t q = top; q > 1; q >>= 1)
    if (point[2] & q) flipped ^= q - 1;
  std::uint64_t position = 0;
  for (std::int64_t& x : point) x ^= flipped;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (const std::int64_t x : point)
      position = position << 1 | static_cast<std::uint64_t>(x >> bit & 1);
  return position;
}

Partition::Partition(const geometry::LevelSet& surface, const CubeMesh& mesh, int ranks)
    : cells_(mesh.cells), blocks_(block_count(mesh.cells, ranks)) {
  if (ranks == 1) return;
  const ActiveMesh coarse = build_active_mesh(surface, blocks_);
  const CutSurface cut = build_cut_surface(coarse);
  std::map<std::uint64_t, double> along;  // the curve
  double total = 0;
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    // A cell is its lowest vertex, the first of every Kuhn tetrahedron.
    const std::int64_t lowest = coarse.node_id[coarse.tets[cut.triangle_tet[t]].node[0]];
    const double amount = share(coarse, cut, t);
    along[hilbert_position(coarse.cube.vertex(lowest), kBits)] += amount;
    total += amount;
  }
  double before = 0;
  for (const auto& [position, amount] : along) {
    while (static_cast<int>(first_.size()) < ranks - 1 &&
           before + 0.5 * amount >= total * static_cast<double>(first_.size() + 1) / ranks)
      first_.push_back(position);
    before += amount;
  }
  if (static_cast<int>(first_.size()) < ranks - 1 ||
      std::adjacent_find(first_.begin(), first_.end()) != first_.end())
    throw InputError(std::to_string(ranks) + " ranks are too many for a mesh of " +
                     std::to_string(mesh.cells) + " cells per edge; use fewer ranks or more cells");
}

Lattice Partition::block(const Lattice& vertex) const {
  const auto along = [&](std::int64_t i) { return std::min(i * blocks_ / cells_, blocks_ - 1); };
  return {along(vertex[0]), along(vertex[1]), along(vertex[2])};
}

int Partition::owner(const Lattice& vertex) const {
  if (first_.empty()) return 0;
  const std::uint64_t position = hilbert_position(block(vertex), kBits);
  return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), position) -
                          first_.begin());
}

}  // namespace traceraft::mesh
