#include "verification/assimilation/fields/point_trace.hpp"

#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::assimilation {
namespace {

std::string text_of(const Point& x) {
  return formatted("(%.4g, %.4g, %.4g)", x[0], x[1], x[2]);
}

}  // namespace

PointTrace trace_at(const fem::SurfaceSpace& space, const std::vector<mesh::SurfacePlace>& places) {
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
  const mesh::NearestTriangle finder(space.surface);
  std::vector<mesh::SurfacePlace> places;
  places.reserve(points.size());
  for (const Point& x : points) {
    const auto nearest = finder.find(x);
    if (nearest.distance > reach)
      throw InputError(
          "point " + std::to_string(places.size() + 1) + ", " + text_of(x) +
          " in units of R, is further than " + format_number(reach) +
          " R from the surface; are the surface, its radius and the unit of length right?");
    places.push_back(nearest.place);
  }
  return trace_at(space, places);
}

}  // namespace traceraft::assimilation
