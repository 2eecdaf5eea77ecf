#include "kernel/mesh/refinement_forest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/core/error.hpp"
#include "kernel/mesh/cut_cells.hpp"
#include "kernel/mesh/lattice_index.hpp"

namespace traceraft::mesh {
namespace {

constexpr int kMostLevels = 8;
constexpr std::int64_t kFewestCoarseCells = 4;
constexpr std::int64_t kSearchCells = 64;  // of the lattice that finds the parts of Γ

// On a segment of length L, φ differs from what is linear between its ends by at most L²/8 times
// its second derivative, and in a tetrahedron of quadratic φ by 1.5 times that of the worst edge.
// This leaves a factor of 2.7 for other φ.
constexpr double kReach = 0.5;

std::int64_t distance_squared(const Lattice& a, const Lattice& b) {
  std::int64_t squares = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) squares += (a[axis] - b[axis]) * (a[axis] - b[axis]);
  return squares;
}

// Whether there is a lattice point in the middle.
bool middle_of(const Lattice& a, const Lattice& b, Lattice& middle) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t sum = a[axis] + b[axis];
    if (sum % 2 != 0) return false;
    middle[axis] = sum / 2;
  }
  return true;
}

}  // namespace

void require_levels(const RefinementLevels& levels) {
  if (levels.levels < 1 || levels.levels > kMostLevels)
    throw InputError("mesh-levels: " + std::to_string(levels.levels) + " is out of range [1, " +
                     std::to_string(kMostLevels) + "]");
  const std::int64_t unit = std::int64_t{1} << levels.levels;
  const std::int64_t least = kFewestCoarseCells * unit;
  if (levels.cells >= least && levels.cells % unit == 0) return;
  const std::int64_t nearest = std::max(least, (levels.cells + unit / 2) / unit * unit);
  throw InputError("cells: " + std::to_string(levels.cells) + " cannot be halved " +
                   std::to_string(levels.levels) + " times to at least " +
                   std::to_string(kFewestCoarseCells) + "; nearest: " + std::to_string(nearest));
}

// Grows a forest from its roots.
class RefinementForest::Builder {
 public:
  Builder(const geometry::LevelSet& surface, const RefinementLevels& levels)
      : surface_(surface), lattice_(levels.lattice()) {
    forest_.levels_ = levels;
  }

  // The tetrahedra of the coarsest mesh that Γ may enter. Throws InputError if there are none.
  void find_roots() {
    require_levels(forest_.levels_);
    const CubeMesh coarse{forest_.levels_.coarsest_cells()};
    const std::vector<bool> seen = seen_by_a_finer_lattice(coarse);
    for (std::int64_t id = 0; id < static_cast<std::int64_t>(seen.size()); ++id) {
      if (!any_around(coarse, coarse.cell(id), seen)) continue;
      for (const auto& corners : kKuhnCorners)
        add_root(coarse.cell(id), corners, seen[static_cast<std::size_t>(id)]);
    }
  }

  void copy_roots(const RefinementForest& other) {
    for (std::size_t root = 0; root < other.bend_.size(); ++root) {
      Cell cell = other.cells_[root];
      for (int& vertex : cell.vertex) vertex = vertex_at(other.vertices_[vertex].at);
      cell.child = -1;
      forest_.cells_.push_back(cell);
    }
    forest_.bend_ = other.bend_;
  }

  // Visits near cells, depth first, and bisects those of which bisects(cell, mark) holds. The mark
  // of a root is its number, that of a child is child_mark(mark of the parent, 0 or 1).
  template <class Bisects, class ChildMark>
  void grow(const Bisects& bisects, const ChildMark& child_mark) {
    std::vector<std::pair<int, int>> todo;  // cell and mark
    for (int root = static_cast<int>(forest_.bend_.size()) - 1; root >= 0; --root)
      todo.emplace_back(root, root);
    while (!todo.empty()) {
      const auto [cell, mark] = todo.back();
      todo.pop_back();
      if (!forest_.cells_[cell].near || !bisects(forest_.cells_[cell], mark)) continue;
      bisect(cell);
      for (const int k : {1, 0})
        todo.emplace_back(forest_.cells_[cell].child + k, child_mark(mark, k));
    }
  }

  // Closes the forest and lists its leaves.
  RefinementForest finished() {
    close();
    list_leaves();
    return std::move(forest_);
  }

 private:
  // The cells of a coarse mesh in which Γ is seen.
  std::vector<bool> seen_by_a_finer_lattice(const CubeMesh& coarse) const {
    const std::int64_t times = std::max<std::int64_t>(1, kSearchCells / coarse.cells);
    const CubeMesh fine{coarse.cells * times};
    std::vector<bool> seen(static_cast<std::size_t>(coarse.cells * coarse.cells * coarse.cells));
    for (const std::int64_t id : find_cut_cells(surface_, fine)) {
      Lattice cell = fine.cell(id);
      for (std::int64_t& coordinate : cell) coordinate /= times;
      seen[static_cast<std::size_t>(coarse.cell_id(cell))] = true;
    }
    return seen;
  }

  // Is one of a cell and its neighbours marked?
  static bool any_around(const CubeMesh& mesh, const Lattice& cell,
                         const std::vector<bool>& marked) {
    for (int k = 0; k < 27; ++k) {
      const Lattice at = {cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1};
      const bool inside = std::all_of(at.begin(), at.end(), [&](std::int64_t coordinate) {
        return coordinate >= 0 && coordinate < mesh.cells;
      });
      if (inside && marked[static_cast<std::size_t>(mesh.cell_id(at))]) return true;
    }
    return false;
  }

  void add_root(const Lattice& place, const std::array<int, 4>& corners, bool seen) {
    const std::int64_t side = std::int64_t{1} << forest_.levels_.levels;
    Cell cell{};
    for (std::size_t i = 0; i < 4; ++i) {
      Lattice at = corner_of(place, corners[i]);
      for (std::int64_t& coordinate : at) coordinate *= side;
      cell.vertex[i] = vertex_at(at);
    }
    cell.turn = 3;
    cell.root = static_cast<int>(forest_.bend_.size());
    forest_.bend_.push_back(bend_in(cell));
    judge(cell);
    if (!cell.near && !seen) return forest_.bend_.pop_back();
    // A part of Γ that no vertex sees: nothing is known of φ between them.
    if (!cell.near) forest_.bend_.back() = std::numeric_limits<double>::max();
    cell.near = true;
    forest_.cells_.push_back(cell);
  }

  // The second derivative of φ along the edges of a cell, per lattice spacing squared.
  double bend_in(const Cell& cell) const {
    double bend = 0;
    for (const auto& [i, j] : kTetEdges) {
      const Vertex &a = forest_.vertices_[cell.vertex[i]], &b = forest_.vertices_[cell.vertex[j]];
      Lattice middle{};
      middle_of(a.at, b.at, middle);
      const double difference = surface_.value(lattice_.position(middle)) - 0.5 * (a.phi + b.phi);
      bend = std::max(
          bend, 8 * std::fabs(difference) / static_cast<double>(distance_squared(a.at, b.at)));
    }
    return bend;
  }

  // Sets cut and near.
  void judge(Cell& cell) const {
    int below = 0;
    double least = std::numeric_limits<double>::infinity();
    for (const int vertex : cell.vertex) {
      const double phi = forest_.vertices_[vertex].phi;
      below += phi < 0;
      least = std::min(least, std::fabs(phi));
    }
    std::int64_t longest = 0;
    for (const auto& [i, j] : kTetEdges)
      longest = std::max(longest, distance_squared(forest_.vertices_[cell.vertex[i]].at,
                                                   forest_.vertices_[cell.vertex[j]].at));
    cell.cut = below > 0 && below < 4;
    cell.near = cell.cut || least <= kReach * static_cast<double>(longest) *
                                         forest_.bend_[static_cast<std::size_t>(cell.root)];
  }

  int vertex_at(const Lattice& at) {
    const auto next = static_cast<int>(forest_.vertices_.size());
    const int vertex = index_.insert(lattice_.vertex_id(at), next);
    if (vertex == next) forest_.vertices_.push_back({at, surface_.value(lattice_.position(at))});
    return vertex;
  }

  // Maubach's rule: vertices (0, …, turn) have a path of edges; the edge from its begin to its end
  // is bisected.
  void bisect(int parent) {
    const Cell cell = forest_.cells_[parent];
    const auto turn = static_cast<std::size_t>(cell.turn);
    Lattice middle{};
    middle_of(forest_.vertices_[cell.vertex[0]].at, forest_.vertices_[cell.vertex[turn]].at,
              middle);
    Cell child = cell;
    child.child = -1;
    ++child.generation;
    child.turn = static_cast<std::int8_t>(cell.turn > 1 ? cell.turn - 1 : 3);
    child.vertex[turn] = vertex_at(middle);
    Cell other = child;
    for (std::size_t i = 0; i < turn; ++i) other.vertex[i] = cell.vertex[i + 1];
    forest_.cells_[parent].child = static_cast<int>(forest_.cells_.size());
    for (Cell* half : {&child, &other}) {
      judge(*half);
      forest_.cells_.push_back(*half);
    }
  }

  bool has_vertex_in_an_edge(const Cell& cell) const {
    return std::any_of(std::begin(kTetEdges), std::end(kTetEdges), [&](const auto& edge) {
      Lattice middle{};
      return middle_of(forest_.vertices_[cell.vertex[edge[0]]].at,
                       forest_.vertices_[cell.vertex[edge[1]]].at, middle) &&
             index_.contains(lattice_.vertex_id(middle));
    });
  }

  void close() {
    for (bool again = true; again;) {
      again = false;
      for (std::size_t cell = 0; cell < forest_.cells_.size(); ++cell) {
        const Cell& at = forest_.cells_[cell];
        if (!at.leaf() || !at.near || !has_vertex_in_an_edge(at)) continue;
        bisect(static_cast<int>(cell));
        again = true;
      }
    }
  }

  void list_leaves() {
    std::vector<std::pair<std::array<std::int64_t, 4>, int>> leaves;
    for (std::size_t k = 0; k < forest_.cells_.size(); ++k) {
      const Cell& cell = forest_.cells_[k];
      if (!cell.leaf() || !cell.cut) continue;
      std::array<std::int64_t, 4> ids;
      for (std::size_t i = 0; i < 4; ++i)
        ids[i] = lattice_.vertex_id(forest_.vertices_[cell.vertex[i]].at);
      std::sort(ids.begin(), ids.end());
      leaves.emplace_back(ids, static_cast<int>(k));
    }
    std::sort(leaves.begin(), leaves.end());
    for (const auto& leaf : leaves) forest_.leaf_cells_.push_back(leaf.second);
  }

  const geometry::LevelSet& surface_;
  const CubeMesh lattice_;
  LatticeIndex index_;
  RefinementForest forest_;
};

RefinementForest::RefinementForest(const geometry::LevelSet& surface,
                                   const RefinementLevels& levels, int generation) {
  Builder builder(surface, levels);
  builder.find_roots();
  builder.grow([&](const Cell& cell, int) { return cell.generation < generation; },
               [](int, int) { return 0; });
  *this = builder.finished();
}

RefinementForest::RefinementForest(const geometry::LevelSet& surface,
                                   const RefinementLevels& levels, const std::vector<bool>& bits) {
  Builder builder(surface, levels);
  builder.find_roots();
  std::size_t next = 0;
  builder.grow(
      [&](const Cell& cell, int) {
        if (next >= bits.size() || (bits[next] && cell.generation >= levels.finest_generation()))
          throw IoError("checkpoint: its mesh is not one of this surface");
        return static_cast<bool>(bits[next++]);
      },
      [](int, int) { return 0; });
  const std::size_t leaves = next;
  *this = builder.finished();
  if (leaves != bits.size() || this->bits() != bits)
    throw IoError("checkpoint: its mesh is not one of this surface");
}

RefinementForest RefinementForest::refined(const geometry::LevelSet& surface,
                                           const std::vector<int>& wanted_generation) const {
  // The largest that is wanted anywhere in a cell.
  std::vector<int> wanted(cells_.size(), 0);
  for (std::size_t t = 0; t < leaf_cells_.size(); ++t)
    wanted[static_cast<std::size_t>(leaf_cells_[t])] =
        std::min(wanted_generation[t], levels_.finest_generation());
  for (std::size_t k = cells_.size(); k-- > 0;)
    if (const int child = cells_[k].child; child >= 0)
      wanted[k] = std::max(wanted[static_cast<std::size_t>(child)],
                           wanted[static_cast<std::size_t>(child) + 1]);
  Builder builder(surface, levels_);
  builder.copy_roots(*this);
  // The mark of a cell is that of this forest which it is, or is a part of.
  builder.grow([&](const Cell& cell,
                   int mark) { return cell.generation < wanted[static_cast<std::size_t>(mark)]; },
               [&](int mark, int k) {
                 const Cell& cell = cells_[static_cast<std::size_t>(mark)];
                 return cell.leaf() ? mark : cell.child + k;
               });
  return builder.finished();
}

std::vector<int> RefinementForest::leaf_generations() const {
  std::vector<int> result;
  result.reserve(leaf_cells_.size());
  for (const int leaf : leaf_cells_)
    result.push_back(cells_[static_cast<std::size_t>(leaf)].generation);
  return result;
}

std::vector<bool> RefinementForest::bits() const {
  std::vector<bool> result;
  std::vector<int> todo;
  for (int root = static_cast<int>(bend_.size()) - 1; root >= 0; --root) todo.push_back(root);
  while (!todo.empty()) {
    const Cell& cell = cells_[static_cast<std::size_t>(todo.back())];
    todo.pop_back();
    if (!cell.near) continue;
    result.push_back(!cell.leaf());
    if (cell.leaf()) continue;
    for (const int k : {1, 0}) todo.push_back(cell.child + k);
  }
  return result;
}

}  // namespace traceraft::mesh
