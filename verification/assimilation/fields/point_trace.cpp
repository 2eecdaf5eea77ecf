#include "verification/assimilation/fields/point_trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::assimilation {
namespace {

using Barycentric = std::array<double, 3>;

// The place of the point of the segment a b that is nearest to x: 0 at a, 1 at b.
double along(const Point& a, const Point& b, const Point& x) {
  const Point edge = b - a;
  const double length2 = edge.squaredNorm();
  return length2 > 0 ? std::clamp((x - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
}

// The point of a triangle that is nearest to x: inside it, or on the nearest of its edges.
Barycentric nearest_in_triangle(const std::array<Point, 3>& corner, const Point& x) {
  const Point u = corner[1] - corner[0], v = corner[2] - corner[0], w = x - corner[0];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 1e-14 * uu * vv) {
    const double b = (vv * u.dot(w) - uv * v.dot(w)) / determinant;
    const double c = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
    if (b >= 0 && c >= 0 && b + c <= 1) return {1 - b - c, b, c};
  }
  Barycentric best{};
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double s = along(corner[k], corner[next], x);
    const double distance = (corner[k] + s * (corner[next] - corner[k]) - x).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = {};
    best[k] = 1 - s;
    best[next] = s;
  }
  return best;
}

// The triangles of Γ_h by the cell of the background mesh that they lie in.
class TriangleFinder {
 public:
  explicit TriangleFinder(const fem::SurfaceSpace& space) : space_(space) {
    const mesh::CutSurface& surface = space.surface;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto corner = corners(static_cast<int>(t));
      const Point middle = (corner[0] + corner[1] + corner[2]) / 3;
      double radius = 0;
      for (const Point& x : corner) radius = std::max(radius, (x - middle).norm());
      cells_[space.mesh.cube.cell_id(cell_of(middle))].push_back(
          {static_cast<int>(t), middle, radius});
    }
  }

  struct Nearest {
    int triangle = -1;
    Barycentric at{};
    double distance = std::numeric_limits<double>::infinity();
  };

  // Looks through growing shells of cells until no nearer triangle can be in the next one.
  Nearest find(const Point& x, double reach) const {
    const mesh::Lattice centre = cell_of(x);
    const double h = space_.h();
    const auto shells = static_cast<int>(std::ceil(reach / h)) + 1;
    Nearest nearest;
    for (int shell = 0; shell <= shells && nearest.distance > (shell - 1) * h; ++shell)
      for_shell(centre, shell, [&](const mesh::Lattice& cell) {
        if (distance_to(cell, x) <= nearest.distance)
          look(space_.mesh.cube.cell_id(cell), x, nearest);
      });
    return nearest;
  }

 private:
  std::array<Point, 3> corners(int t) const {
    const auto& triangle = space_.surface.triangles[t];
    return {space_.surface.position[triangle[0]], space_.surface.position[triangle[1]],
            space_.surface.position[triangle[2]]};
  }

  mesh::Lattice cell_of(const Point& x) const {
    mesh::Lattice cell;
    for (int d = 0; d < 3; ++d)
      cell[d] = std::clamp<std::int64_t>(
          static_cast<std::int64_t>(std::floor((x[d] + mesh::kBoxHalfWidth) / space_.h())), 0,
          space_.mesh.cube.cells - 1);
    return cell;
  }

  template <class Action>
  void for_shell(const mesh::Lattice& centre, int shell, const Action& action) const {
    const std::int64_t cells = space_.mesh.cube.cells;
    for (int i = -shell; i <= shell; ++i)
      for (int j = -shell; j <= shell; ++j)
        for (int k = -shell; k <= shell; ++k) {
          if (std::max({std::abs(i), std::abs(j), std::abs(k)}) != shell) continue;
          const mesh::Lattice cell{centre[0] + i, centre[1] + j, centre[2] + k};
          if (std::all_of(cell.begin(), cell.end(),
                          [cells](std::int64_t c) { return c >= 0 && c < cells; }))
            action(cell);
        }
  }

  // Triangles lie in their cells, but for roundoff: nothing in one is nearer than that.
  double distance_to(const mesh::Lattice& cell, const Point& x) const {
    constexpr double kRoundoff = 1e-12;
    double squares = 0;
    for (int d = 0; d < 3; ++d) {
      const double low = -mesh::kBoxHalfWidth + static_cast<double>(cell[d]) * space_.h();
      const double beside = std::max({low - x[d], x[d] - low - space_.h(), 0.0});
      squares += beside * beside;
    }
    return std::sqrt(squares) - kRoundoff;
  }

  void look(std::int64_t cell, const Point& x, Nearest& nearest) const {
    const auto found = cells_.find(cell);
    if (found == cells_.end()) return;
    for (const auto& [t, middle, radius] : found->second) {
      const double farthest = nearest.distance + radius;
      if ((middle - x).squaredNorm() > farthest * farthest) continue;
      const auto corner = corners(t);
      const Barycentric at = nearest_in_triangle(corner, x);
      const double distance =
          (at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2] - x).norm();
      if (distance < nearest.distance) nearest = {t, at, distance};
    }
  }

  const fem::SurfaceSpace& space_;
  // Within a ball, most of which are too far away to be looked at.
  struct Bounded {
    int triangle;
    Point middle;
    double radius;
  };
  std::unordered_map<std::int64_t, std::vector<Bounded>> cells_;
};

std::string text_of(const Point& x) {
  return formatted("(%.4g, %.4g, %.4g)", x[0], x[1], x[2]);
}

}  // namespace

PointTrace trace_at(const fem::SurfaceSpace& space, const std::vector<SurfacePlace>& places) {
  const mesh::CutSurface& surface = space.surface;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(6 * places.size());
  for (std::size_t row = 0; row < places.size(); ++row)
    for (int k = 0; k < 3; ++k) {
      const auto& [triangle, at] = places[row];
      const mesh::CutPoint& cut = surface.points[surface.triangles[triangle][k]];
      entries.emplace_back(static_cast<int>(row), cut.low, at[k] * (1 - cut.s));
      entries.emplace_back(static_cast<int>(row), cut.high, at[k] * cut.s);
    }
  PointTrace trace(static_cast<Eigen::Index>(places.size()), space.nodes());
  trace.setFromTriplets(entries.begin(), entries.end());
  return trace;
}

PointTrace point_trace(const fem::SurfaceSpace& space, const std::vector<Point>& points,
                       double reach) {
  const TriangleFinder finder(space);
  std::vector<SurfacePlace> places;
  places.reserve(points.size());
  for (const Point& x : points) {
    const auto nearest = finder.find(x, reach);
    if (nearest.distance > reach)
      throw InputError(
          "point " + std::to_string(places.size() + 1) + ", " + text_of(x) +
          " in units of R, is further than " + format_number(reach) +
          " R from the surface; are the surface, its radius and the unit of length right?");
    places.push_back({nearest.triangle, nearest.at});
  }
  return trace_at(space, places);
}

}  // namespace traceraft::assimilation
