#include "kernel/observables/rafts.hpp"

#include <algorithm>
#include <numeric>

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

}  // namespace

RaftFinder::RaftFinder(std::shared_ptr<const SurfaceSpace> space) : space_(std::move(space)) {}

RaftReport RaftFinder::find(ConstVec c, double level) const {
  const CutSurface& surface = space_->surface;
  const std::vector<Point>& position = surface.position;
  const Vec value = trace(*space_, c);
  RaftReport report;
  report.c_min = value.minCoeff();
  report.c_max = value.maxCoeff();

  DisjointSets sets(surface.points.size());
  for (const auto& triangle : surface.triangles) {
    int inside = -1;
    for (const int p : triangle)
      if (value[p] > level) {
        if (inside >= 0) sets.join(inside, p);
        inside = p;
      }
  }
  std::vector<int> raft_of_root(surface.points.size(), -1);
  std::vector<Point> moment;
  std::vector<int> raft_of_point(surface.points.size(), -1);
  for (int p = 0; p < value.size(); ++p) {
    if (!(value[p] > level)) continue;
    int& raft = raft_of_root[sets.find(p)];
    if (raft < 0) {
      raft = static_cast<int>(report.rafts.size());
      report.rafts.push_back({0, 0, Point::Zero()});
      moment.push_back(Point::Zero());
    }
    raft_of_point[p] = raft;
  }
  for (const auto& triangle : surface.triangles) {
    int raft = -1;
    for (const int p : triangle) raft = std::max(raft, raft_of_point[p]);
    if (raft < 0) continue;
    const auto& [i, j, k] = triangle;
    const Piece piece =
        piece_above({position[i], position[j], position[k]}, {value[i], value[j], value[k]}, level);
    report.rafts[raft].area += piece.area;
    report.rafts[raft].perimeter += piece.curve;
    moment[raft] += piece.moment;
  }
  std::vector<double> nearest(report.rafts.size(), 1e300);
  for (std::size_t p = 0; p < raft_of_point.size(); ++p) {
    const int raft = raft_of_point[p];
    if (raft < 0) continue;
    const double distance = (position[p] - moment[raft] / report.rafts[raft].area).norm();
    if (distance < nearest[raft]) {
      nearest[raft] = distance;
      report.rafts[raft].centre = position[p];
    }
  }
  for (const Raft& raft : report.rafts) {
    report.area += raft.area;
    report.perimeter += raft.perimeter;
  }
  std::sort(report.rafts.begin(), report.rafts.end(),
            [](const Raft& a, const Raft& b) { return a.area > b.area; });
  return report;
}

}  // namespace traceraft
