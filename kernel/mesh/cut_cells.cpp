#include "kernel/mesh/cut_cells.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unordered_set>
#include <utility>

#include "kernel/core/error.hpp"

namespace traceraft::mesh {
namespace {

constexpr std::int64_t kSeedIntervals = 64;

std::string describe(const Point& x) {
  std::ostringstream text;
  text.precision(3);
  text << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

bool negative_at(const geometry::LevelSet& surface, const CubeMesh& mesh, const Lattice& vertex) {
  const Point x = mesh.position(vertex);
  const double phi = surface.value(x);
  if (!std::isfinite(phi))
    throw InputError("surface: the level set is not finite at " + describe(x) +
                     "; give a formula that is defined in the whole box");
  return phi < 0;
}

// The lattice on which the walk looks for its starting points.
class SeedLattice {
 public:
  SeedLattice(const geometry::LevelSet& surface, const CubeMesh& mesh)
      : surface_(surface), mesh_(mesh), intervals_(std::min(mesh.cells, kSeedIntervals)) {
    const std::int64_t points = intervals_ + 1;
    negative_.reserve(static_cast<std::size_t>(points * points * points));
    for (std::int64_t k = 0; k < points; ++k)
      for (std::int64_t j = 0; j < points; ++j)
        for (std::int64_t i = 0; i < points; ++i)
          negative_.push_back(negative_at(surface, mesh, vertex({i, j, k})));
  }

  // Calls visit(cell) for one cut cell on every lattice interval along which the sign changes.
  template <class Visit>
  void for_each_seed(const Visit& visit) const {
    const std::int64_t points = intervals_ + 1;
    for (std::int64_t k = 0; k < points; ++k)
      for (std::int64_t j = 0; j < points; ++j)
        for (std::int64_t i = 0; i < points; ++i)
          for (std::size_t axis = 0; axis < 3; ++axis) {
            Lattice from = {i, j, k}, to = from;
            if (++to[axis] >= points || negative(from) == negative(to)) continue;
            visit(bisect(vertex(from), vertex(to), axis, negative(from)));
          }
  }

 private:
  Lattice vertex(const Lattice& point) const {
    const auto scaled = [&](std::int64_t i) { return i * mesh_.cells / intervals_; };
    return {scaled(point[0]), scaled(point[1]), scaled(point[2])};
  }
  bool negative(const Lattice& p) const {
    const std::int64_t points = intervals_ + 1;
    return negative_[static_cast<std::size_t>(p[0] + points * (p[1] + points * p[2]))];
  }
  // A cell with a sign change on its edge along `axis`, between two vertices of different sign.
  Lattice bisect(Lattice from, Lattice to, std::size_t axis, bool from_negative) const {
    while (to[axis] - from[axis] > 1) {
      Lattice middle = from;
      middle[axis] = (from[axis] + to[axis]) / 2;
      (negative_at(surface_, mesh_, middle) == from_negative ? from : to) = middle;
    }
    for (std::int64_t& coordinate : from) coordinate = std::min(coordinate, mesh_.cells - 1);
    return from;
  }

  const geometry::LevelSet& surface_;
  const CubeMesh& mesh_;
  std::int64_t intervals_;
  std::vector<bool> negative_;
};

// Corners of the face of a cell on side 0 or 1 of an axis.
int face_corner(std::size_t axis, int side, int which) {
  const int a = static_cast<int>((axis + 1) % 3), b = static_cast<int>((axis + 2) % 3);
  return side << axis | (which & 1) << a | (which >> 1) << b;
}

class Walk {
 public:
  Walk(const geometry::LevelSet& surface, const CubeMesh& mesh, const Partition& partition,
       int rank)
      : surface_(surface),
        mesh_(mesh),
        partition_(partition),
        rank_(rank),
        told_(static_cast<std::size_t>(partition.ranks())) {}

  // Walks from a cell that every rank knows of.
  void from(const Lattice& seed) {
    partition_.for_each_owner(seed, [&](int owner) {
      if (owner == rank_) step_on(seed);
    });
    while (!front_.empty()) {
      const Lattice cell = front_.back();
      front_.pop_back();
      visit(cell);
    }
  }

  // Walks on from where the walks of other ranks reached cells of this one, until all are done.
  void join(const Communicator& ranks) {
    while (ranks.any(std::any_of(told_.begin(), told_.end(),
                                 [](const Told& told) { return !told.news.empty(); }))) {
      Lists<std::int64_t> news;
      for (Told& told : told_) news.push_back(std::exchange(told.news, {}));
      for (const std::vector<std::int64_t>& cells : exchange_lists(ranks, news))
        for (const std::int64_t id : cells) from(mesh_.cell(id));
    }
  }

  std::vector<std::int64_t> cells() const {
    std::vector<std::int64_t> result(seen_.begin(), seen_.end());
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  void step_on(const Lattice& cell) {
    if (seen_.insert(mesh_.cell_id(cell)).second) front_.push_back(cell);
  }

  void enqueue(const Lattice& cell) {
    partition_.for_each_owner(cell, [&](int owner) {
      const std::int64_t id = mesh_.cell_id(cell);
      if (owner == rank_)
        step_on(cell);
      else if (told_[owner].cells.insert(id).second)
        told_[owner].news.push_back(id);
    });
  }

  void visit(const Lattice& cell) {
    bool negative[8];
    for (int corner = 0; corner < 8; ++corner)
      negative[corner] = negative_at(surface_, mesh_, corner_of(cell, corner));
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        int below = 0;
        for (int which = 0; which < 4; ++which) below += negative[face_corner(axis, side, which)];
        if (below == 0 || below == 4) continue;
        Lattice next = cell;
        next[axis] += side ? 1 : -1;
        if (next[axis] < 0 || next[axis] >= mesh_.cells)
          throw InputError("surface: it reaches the boundary of the box [-5/3, 5/3]^3 near " +
                           describe(mesh_.position(cell)) +
                           ", so it is not closed; scale it to fit inside");
        enqueue(next);
      }
  }

  struct Told {
    std::unordered_set<std::int64_t> cells;  // that another rank knows of from this one,
    std::vector<std::int64_t> news;          // or will
  };

  const geometry::LevelSet& surface_;
  const CubeMesh& mesh_;
  const Partition& partition_;
  const int rank_;
  std::unordered_set<std::int64_t> seen_;
  std::vector<Lattice> front_;
  std::vector<Told> told_;  // per rank
};

}  // namespace

std::vector<std::int64_t> find_cut_cells(const geometry::LevelSet& surface, const CubeMesh& mesh,
                                         const Partition& partition, const Communicator& ranks) {
  const SeedLattice seeds(surface, mesh);
  Walk walk(surface, mesh, partition, ranks.rank());
  seeds.for_each_seed([&](const Lattice& seed) { walk.from(seed); });
  walk.join(ranks);
  std::vector<std::int64_t> cells = walk.cells();
  if (!ranks.any(!cells.empty()))
    throw InputError(
        "surface: the level set has one sign in the whole box [-5/3, 5/3]^3, so there is no "
        "surface inside it");
  return cells;
}

}  // namespace traceraft::mesh
