#include "kernel/mesh/cut_surface.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernel/core/error.hpp"

namespace traceraft::mesh {
namespace {

int edge_between(int i, int j) {
  static constexpr int table[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
  return table[i][j];
}

}  // namespace

CutPolygon cut_polygon(const ActiveMesh& mesh, const ActiveTet& tet) {
  std::array<int, 4> order{};  // negative vertices first
  int negatives = 0, filled = 0;
  for (int sign = 0; sign < 2; ++sign)
    for (int i = 0; i < 4; ++i)
      if ((mesh.phi[tet.node[i]] < 0) == (sign == 0)) {
        order[filled++] = i;
        negatives += sign == 0;
      }
  const auto& [a, b, c, d] = order;
  CutPolygon polygon;
  if (negatives == 1)
    polygon = {3, {edge_between(a, b), edge_between(a, c), edge_between(a, d)}};
  else if (negatives == 3)
    polygon = {3, {edge_between(a, d), edge_between(b, d), edge_between(c, d)}};
  else
    polygon = {4, {edge_between(a, c), edge_between(a, d), edge_between(b, d), edge_between(b, c)}};
  // The lists above are counter-clockwise from outside if (a, b, c, d) is right-handed.
  bool odd = mesh.shape(tet).left_handed;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) odd ^= order[j] > order[i];
  if (odd) std::swap(polygon.edge[1], polygon.edge[polygon.count - 1]);
  return polygon;
}

Point cut_normal(const ActiveMesh& mesh, const ActiveTet& tet) {
  Point gradient = Point::Zero();
  const auto& basis = mesh.shape(tet).gradients;
  for (int i = 0; i < 4; ++i) gradient += mesh.phi[tet.node[i]] * basis.row(i).transpose();
  return gradient.normalized();
}

CutSurface build_cut_surface(const ActiveMesh& mesh) {
  CutSurface surface;
  std::vector<int> point_on_edge(mesh.edges.size(), -1);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [low, high] = mesh.edges[e];
    const double phi_low = mesh.phi[low], phi_high = mesh.phi[high];
    if ((phi_low < 0) == (phi_high < 0)) continue;
    point_on_edge[e] = static_cast<int>(surface.points.size());
    const double s = cut_fraction(phi_low, phi_high);
    surface.points.push_back({low, high, s});
    surface.position.push_back((1 - s) * mesh.position(low) + s * mesh.position(high));
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const CutPolygon polygon = cut_polygon(mesh, mesh.tets[t]);
    const auto point = [&](int i) { return point_on_edge[mesh.tets[t].edge[polygon.edge[i]]]; };
    for (int i = 2; i < polygon.count; ++i) {
      surface.triangles.push_back({point(0), point(i - 1), point(i)});
      surface.triangle_tet.push_back(static_cast<int>(t));
    }
  }
  const std::vector<Point>& position = surface.position;
  for (const auto& [a, b, c] : surface.triangles)
    surface.triangle_area.push_back(triangle_area(position[a], position[b], position[c]));
  return surface;
}

std::int64_t euler_characteristic(const ActiveMesh& mesh, const CutSurface& surface,
                                  const Communicator& ranks) {
  // Γ_h is closed: every edge belongs to two triangles.
  double twice = 0;
  for (const CutPoint& point : surface.points) twice += mesh.owns(point.low) ? 2 : 0;
  for (const int tet : surface.triangle_tet) twice -= mesh.owns(mesh.tets[tet]) ? 1 : 0;
  return std::llround(ranks.sum(twice) / 2);
}

Resolution surface_resolution(const ActiveMesh& mesh, const CutSurface& surface,
                              const Communicator& ranks) {
  std::vector<Point> turned(mesh.nodes(), Point::Zero());
  std::vector<double> total(mesh.nodes(), 0.0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const double area = surface.triangle_area[t];
    const ActiveTet& tet = mesh.tets[surface.triangle_tet[t]];
    const Point normal = cut_normal(mesh, tet);
    for (const int node : tet.node) {
      turned[node] += area * normal;
      total[node] += area;
    }
  }
  // Only this rank's nodes count, as ghosts do not have all their tetrahedra here.
  std::vector<double> worst = {1, 0, 0, 0};
  for (int node = 0; node < mesh.owned_nodes; ++node) {
    const double ratio = turned[node].norm() / total[node];
    const Point x = mesh.position(node);
    if (ratio < worst[0]) worst = {ratio, x[0], x[1], x[2]};
  }
  for (const std::vector<double>& other : gather_everywhere(ranks, worst))
    worst = std::min(worst, other);
  return {worst[0], Point(worst[1], worst[2], worst[3])};
}

void require_resolution(const ActiveMesh& mesh, const CutSurface& surface,
                        const Communicator& ranks) {
  const Resolution resolution = surface_resolution(mesh, surface, ranks);
  if (resolution.worst >= kCoarsestResolution) return;
  std::ostringstream text;
  text.precision(3);
  text << "cells: " << mesh.cube.cells << " per edge are too coarse for this surface near ("
       << resolution.where[0] << ", " << resolution.where[1] << ", " << resolution.where[2]
       << "); try " << 2 * mesh.cube.cells;
  throw InputError(text.str());
}

}  // namespace traceraft::mesh
