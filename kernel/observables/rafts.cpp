#include "kernel/observables/rafts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "kernel/fem/trace.hpp"

namespace traceraft::observables {
namespace {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void join(int a, int b) { parent_[find(a)] = find(b); }

 private:
  std::vector<int> parent_;
};

// The part of a triangle above the level, as a polygon with 3 or 4 corners, and the piece of the
// level curve that bounds it.
struct Piece {
  double area = 0;
  Point moment = Point::Zero();  // area times centroid
  double curve = 0;
};

Piece piece_above(const std::array<Point, 3>& x, const std::array<double, 3>& value, double level) {
  Point corner[4], crossing[2];
  int corners = 0, crossings = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (value[i] > level) corner[corners++] = x[i];
    if ((value[i] > level) != (value[j] > level)) {
      const double s = (level - value[i]) / (value[j] - value[i]);
      crossing[crossings] = x[i] + s * (x[j] - x[i]);
      corner[corners++] = crossing[crossings++];
    }
  }
  Piece piece;
  for (int i = 2; i < corners; ++i) {
    const double area = mesh::triangle_area(corner[0], corner[i - 1], corner[i]);
    piece.area += area;
    piece.moment += area / 3 * (corner[0] + corner[i - 1] + corner[i]);
  }
  if (crossings == 2) piece.curve = (crossing[1] - crossing[0]).norm();
  return piece;
}

// The sums of a raft that a rank or the whole surface has while the raft is put together.
struct Sums {
  double area = 0, perimeter = 0;
  double moment[3] = {0, 0, 0};  // area times centre of area
  // The first of the edges it has points on, by the global ids of their nodes.
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = low;

  void see(std::int64_t low_, std::int64_t high_) {
    if (std::pair(low_, high_) < std::pair(low, high)) low = low_, high = high_;
  }
  void add(double area_, double perimeter_, const double* moment_) {
    area += area_;
    perimeter += perimeter_;
    for (int axis = 0; axis < 3; ++axis) moment[axis] += moment_[axis];
  }
};

// The pieces of rafts made of this rank's own triangles.
struct Pieces {
  std::vector<Sums> sums;
  std::vector<int> of_point;  // −1: not in a piece
};

Pieces find_pieces(const fem::SurfaceSpace& space, const Vec& value, double level) {
  const mesh::CutSurface& surface = space.surface;
  DisjointSets sets(surface.points.size());
  std::vector<char> above(surface.points.size(), 0);  // and in a triangle of this rank
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!space.owns_triangle(t)) continue;
    int inside = -1;
    for (const int p : surface.triangles[t])
      if (value[p] > level) {
        if (inside >= 0) sets.join(inside, p);
        inside = p;
        above[p] = 1;
      }
  }
  Pieces pieces{{}, std::vector<int>(surface.points.size(), -1)};
  std::vector<int> piece_of_root(surface.points.size(), -1);
  for (std::size_t p = 0; p < above.size(); ++p) {
    if (!above[p]) continue;
    int& piece = piece_of_root[sets.find(static_cast<int>(p))];
    if (piece < 0) {
      piece = static_cast<int>(pieces.sums.size());
      pieces.sums.emplace_back();
    }
    pieces.of_point[p] = piece;
    const mesh::CutPoint& point = surface.points[p];
    pieces.sums[piece].see(space.mesh.node_id[point.low], space.mesh.node_id[point.high]);
  }
  const std::vector<Point>& x = surface.position;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!space.owns_triangle(t)) continue;
    const auto& [i, j, k] = surface.triangles[t];
    const int piece = std::max({pieces.of_point[i], pieces.of_point[j], pieces.of_point[k]});
    if (piece < 0) continue;
    const Piece part = piece_above({x[i], x[j], x[k]}, {value[i], value[j], value[k]}, level);
    const double stretch = surface.triangle_area[t] / mesh::triangle_area(x[i], x[j], x[k]);
    const Point moment = stretch * part.moment;
    pieces.sums[piece].add(stretch * part.area, part.curve, moment.data());
  }
  return pieces;
}

// A point that triangles of other ranks may have, too, and the piece it belongs to here.
struct Link {
  std::int64_t low, high;  // the nodes of its edge, by their global ids
  std::int64_t piece;
};

std::vector<Link> find_links(const fem::SurfaceSpace& space,
                             const std::vector<int>& piece_of_point) {
  std::vector<Link> links;
  if (space.communicator->size() == 1) return links;
  std::vector<char> shared(piece_of_point.size(), 0);
  for (std::size_t t = 0; t < space.surface.triangles.size(); ++t)
    if (!space.owns_triangle(t))
      for (const int p : space.surface.triangles[t]) shared[p] = 1;
  for (std::size_t p = 0; p < shared.size(); ++p) {
    const mesh::CutPoint& point = space.surface.points[p];
    const bool inner = !shared[p] && space.mesh.owns(point.low) && space.mesh.owns(point.high);
    if (piece_of_point[p] >= 0 && !inner)
      links.push_back(
          {space.mesh.node_id[point.low], space.mesh.node_id[point.high], piece_of_point[p]});
  }
  return links;
}

// Joins the pieces of all ranks to rafts; every rank does the same.
struct Merged {
  std::vector<Sums> rafts;
  std::vector<int> raft_of_piece;  // of this rank
};

Merged merge(const fem::SurfaceSpace& space, const Pieces& pieces) {
  const Communicator& ranks = *space.communicator;
  const Lists<Sums> sums = gather_everywhere(ranks, pieces.sums);
  const Lists<Link> links = gather_everywhere(ranks, find_links(space, pieces.of_point));
  std::vector<int> first = {0};  // piece of each rank
  for (const auto& list : sums) first.push_back(first.back() + static_cast<int>(list.size()));
  std::vector<Link> all;
  for (std::size_t rank = 0; rank < links.size(); ++rank)
    for (Link link : links[rank]) {
      link.piece += first[rank];
      all.push_back(link);
    }
  const auto place = [](const Link& link) { return std::pair(link.low, link.high); };
  std::sort(all.begin(), all.end(),
            [&](const Link& a, const Link& b) { return place(a) < place(b); });
  DisjointSets sets(first.back());
  for (std::size_t k = 1; k < all.size(); ++k)
    if (place(all[k - 1]) == place(all[k]))
      sets.join(static_cast<int>(all[k - 1].piece), static_cast<int>(all[k].piece));
  Merged merged;
  std::vector<int> raft_of_root(first.back(), -1);
  for (std::size_t rank = 0; rank < sums.size(); ++rank)
    for (std::size_t piece = 0; piece < sums[rank].size(); ++piece) {
      int& raft = raft_of_root[sets.find(first[rank] + static_cast<int>(piece))];
      if (raft < 0) {
        raft = static_cast<int>(merged.rafts.size());
        merged.rafts.emplace_back();
      }
      const Sums& part = sums[rank][piece];
      merged.rafts[raft].add(part.area, part.perimeter, part.moment);
      merged.rafts[raft].see(part.low, part.high);
      if (static_cast<int>(rank) == ranks.rank()) merged.raft_of_piece.push_back(raft);
    }
  return merged;
}

Point centre_of(const Sums& raft) {
  return Eigen::Map<const Point>(raft.moment) / raft.area;
}

// From the centre of each raft to the nearest of its points.
std::vector<double> find_distances(const fem::SurfaceSpace& space, const Pieces& pieces,
                                   const Merged& merged) {
  std::vector<double> nearest(merged.rafts.size(), 1e300);
  for (std::size_t p = 0; p < pieces.of_point.size(); ++p) {
    if (pieces.of_point[p] < 0) continue;
    const int raft = merged.raft_of_piece[pieces.of_point[p]];
    const double distance = (space.surface.position[p] - centre_of(merged.rafts[raft])).norm();
    nearest[raft] = std::min(nearest[raft], distance);
  }
  for (const std::vector<double>& others : gather_everywhere(*space.communicator, nearest))
    for (std::size_t raft = 0; raft < others.size(); ++raft)
      nearest[raft] = std::min(nearest[raft], others[raft]);
  return nearest;
}

// Sums over ranks differ by roundoff from those over one.
double without_roundoff(double area) {
  constexpr int kBits = 30;
  int exponent = 0;
  const double mantissa = std::frexp(area, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, kBits)), exponent - kBits);
}

// The largest raft first; equally large ones in the order of their nodes, which is the same on any
// number of ranks.
std::vector<int> by_size(const std::vector<Sums>& rafts) {
  std::vector<int> order(rafts.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const Sums &first = rafts[a], &second = rafts[b];
    const double larger = without_roundoff(first.area), smaller = without_roundoff(second.area);
    if (larger != smaller) return larger > smaller;
    return std::pair(first.low, first.high) < std::pair(second.low, second.high);
  });
  return order;
}

}  // namespace

RaftFinder::RaftFinder(std::shared_ptr<const fem::SurfaceSpace> space) : space_(std::move(space)) {}

RaftReport RaftFinder::find(VecView c, double level) const {
  Vec buffer;
  const Vec value = fem::trace(*space_, space_->with_ghosts(c, buffer));
  const Pieces pieces = find_pieces(*space_, value, level);
  const Merged merged = merge(*space_, pieces);
  const std::vector<double> distances = find_distances(*space_, pieces, merged);
  RaftReport report;
  report.c_min = space_->communicator->min(value.minCoeff());
  report.c_max = space_->communicator->max(value.maxCoeff());
  std::vector<int> number(merged.rafts.size());
  for (const int raft : by_size(merged.rafts)) {
    const Sums& sums = merged.rafts[raft];
    report.rafts.push_back({sums.area, sums.perimeter, centre_of(sums), distances[raft]});
    number[raft] = static_cast<int>(report.rafts.size());
  }
  for (const Sums& sums : merged.rafts) {
    report.area += sums.area;
    report.perimeter += sums.perimeter;
  }
  for (const int piece : pieces.of_point)
    report.of_point.push_back(piece < 0 ? 0 : number[merged.raft_of_piece[piece]]);
  return report;
}

int RaftFinder::regions_below(VecView c, double level) const {
  Vec buffer;
  const Vec value = -fem::trace(*space_, space_->with_ghosts(c, buffer));
  return static_cast<int>(merge(*space_, find_pieces(*space_, value, -level)).rafts.size());
}

}  // namespace traceraft::observables
