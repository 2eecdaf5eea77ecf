#include "kernel/observables/rafts.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "kernel/fem/trace.hpp"

namespace traceraft {
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
    const double area = 0.5 * (corner[i - 1] - corner[0]).cross(corner[i] - corner[0]).norm();
    piece.area += area;
    piece.moment += area / 3 * (corner[0] + corner[i - 1] + corner[i]);
  }
  if (crossings == 2) piece.curve = (crossing[1] - crossing[0]).norm();
  return piece;
}

// What a rank or the whole surface knows of a raft while it is put together.
struct Sums {
  double area = 0, perimeter = 0;
  double moment[3] = {0, 0, 0};  // area times centre of area

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

Pieces find_pieces(const SurfaceSpace& space, const Vec& value, double level) {
  const CutSurface& surface = space.surface;
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
  }
  const std::vector<Point>& x = surface.position;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!space.owns_triangle(t)) continue;
    const auto& [i, j, k] = surface.triangles[t];
    const int piece = std::max({pieces.of_point[i], pieces.of_point[j], pieces.of_point[k]});
    if (piece < 0) continue;
    const Piece part = piece_above({x[i], x[j], x[k]}, {value[i], value[j], value[k]}, level);
    pieces.sums[piece].add(part.area, part.curve, part.moment.data());
  }
  return pieces;
}

// A point that triangles of other ranks may have, too, and the piece it belongs to here.
struct Link {
  std::int64_t low, high;  // the nodes of its edge, by their global ids
  std::int64_t piece;
};

std::vector<Link> find_links(const SurfaceSpace& space, const std::vector<int>& piece_of_point) {
  std::vector<Link> links;
  if (space.communicator->size() == 1) return links;
  std::vector<char> shared(piece_of_point.size(), 0);
  for (std::size_t t = 0; t < space.surface.triangles.size(); ++t)
    if (!space.owns_triangle(t))
      for (const int p : space.surface.triangles[t]) shared[p] = 1;
  for (std::size_t p = 0; p < shared.size(); ++p) {
    const CutPoint& point = space.surface.points[p];
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

Merged merge(const SurfaceSpace& space, const Pieces& pieces) {
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
      if (static_cast<int>(rank) == ranks.rank()) merged.raft_of_piece.push_back(raft);
    }
  return merged;
}

// The point of each raft nearest to its centre of area.
std::vector<Point> find_centres(const SurfaceSpace& space, const Pieces& pieces,
                                const Merged& merged) {
  struct Candidate {
    double distance;
    double x[3];
  };
  std::vector<Candidate> nearest(merged.rafts.size(), {1e300, {0, 0, 0}});
  for (std::size_t p = 0; p < pieces.of_point.size(); ++p) {
    if (pieces.of_point[p] < 0) continue;
    const int raft = merged.raft_of_piece[pieces.of_point[p]];
    const Sums& sums = merged.rafts[raft];
    const Point& x = space.surface.position[p];
    const Point middle = Eigen::Map<const Point>(sums.moment) / sums.area;
    const double distance = (x - middle).norm();
    if (distance < nearest[raft].distance) nearest[raft] = {distance, {x[0], x[1], x[2]}};
  }
  for (const std::vector<Candidate>& others : gather_everywhere(*space.communicator, nearest))
    for (std::size_t raft = 0; raft < others.size(); ++raft)
      if (others[raft].distance < nearest[raft].distance) nearest[raft] = others[raft];
  std::vector<Point> centres;
  for (const Candidate& candidate : nearest) centres.emplace_back(candidate.x);
  return centres;
}

}  // namespace

RaftFinder::RaftFinder(std::shared_ptr<const SurfaceSpace> space) : space_(std::move(space)) {}

RaftReport RaftFinder::find(ConstVec c, double level) const {
  Vec buffer;
  const Vec value = trace(*space_, space_->with_ghosts(c, buffer));
  const Pieces pieces = find_pieces(*space_, value, level);
  const Merged merged = merge(*space_, pieces);
  const std::vector<Point> centres = find_centres(*space_, pieces, merged);
  RaftReport report;
  report.c_min = space_->communicator->min(value.minCoeff());
  report.c_max = space_->communicator->max(value.maxCoeff());
  for (std::size_t raft = 0; raft < merged.rafts.size(); ++raft) {
    const Sums& sums = merged.rafts[raft];
    report.rafts.push_back({sums.area, sums.perimeter, centres[raft]});
    report.area += sums.area;
    report.perimeter += sums.perimeter;
  }
  std::sort(report.rafts.begin(), report.rafts.end(),
            [](const Raft& a, const Raft& b) { return a.area > b.area; });
  return report;
}

}  // namespace traceraft
