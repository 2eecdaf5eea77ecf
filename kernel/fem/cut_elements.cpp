#include "kernel/fem/cut_elements.hpp"

#include <algorithm>

namespace traceraft {
namespace {

CutElement make_element(const ActiveMesh& mesh, const ActiveTet& tet) {
  CutElement element{};
  element.node = tet.node;
  element.edge = tet.edge;
  const CutPolygon polygon = cut_polygon(mesh, tet);
  element.corners = polygon.count;
  for (int v = 0; v < polygon.count; ++v) {
    const auto& [low, high] = kTetEdges[polygon.edge[v]];
    element.cut_edge[v] = static_cast<signed char>(polygon.edge[v]);
    element.s[v] = cut_fraction(mesh.phi[tet.node[low]], mesh.phi[tet.node[high]]);
  }
  const std::array<Point, 4> corner = corners_of(mesh, element);
  for (int t = 0; t < element.triangles(); ++t) {
    const auto& [a, b, c] = kPolygonTriangles[t];
    element.triangle_area[t] = 0.5 * (corner[b] - corner[a]).cross(corner[c] - corner[a]).norm();
  }
  const double h = mesh.cube.h(), volume = h * h * h / 6;
  const Eigen::Matrix<double, 4, 3> gradient = scaled_gradients(tet.kuhn) / h;
  const Eigen::Matrix<double, 4, 1> along = gradient * cut_normal(mesh, tet);
  for (int e = 0; e < 6; ++e) {
    const auto& [i, j] = kTetEdges[e];
    const double normal_part = along[i] * along[j];
    const double full = gradient.row(i).dot(gradient.row(j));
    element.stiffness[e] = element.area() * (full - normal_part);
    element.normal[e] = volume * normal_part;
  }
  return element;
}

}  // namespace

std::array<Point, 4> corners_of(const ActiveMesh& mesh, const CutElement& element) {
  std::array<Point, 4> corner;
  for (int v = 0; v < element.corners; ++v) {
    const auto& [low, high] = kTetEdges[element.cut_edge[v]];
    corner[v] = (1 - element.s[v]) * mesh.position(element.node[low]) +
                element.s[v] * mesh.position(element.node[high]);
  }
  return corner;
}

std::vector<CutElement> build_cut_elements(const ActiveMesh& mesh) {
  std::vector<CutElement> elements;
  elements.reserve(mesh.tets.size());
  for (const ActiveTet& tet : mesh.tets) elements.push_back(make_element(mesh, tet));
  return elements;
}

std::vector<RowBlock> split_rows(const ActiveMesh& mesh, int parts) {
  std::vector<RowBlock> blocks;
  const auto edge_from = [&](int node) {
    return static_cast<int>(
        std::lower_bound(mesh.edges.begin(), mesh.edges.end(), node,
                         [](const ActiveEdge& edge, int low) { return edge.low < low; }) -
        mesh.edges.begin());
  };
  for (int part = 0; part < parts; ++part) {
    RowBlock block{};
    block.row_begin = static_cast<int>(std::int64_t{mesh.owned_nodes} * part / parts);
    block.row_end = static_cast<int>(std::int64_t{mesh.owned_nodes} * (part + 1) / parts);
    block.edge_begin = edge_from(block.row_begin);
    block.edge_end = edge_from(block.row_end);
    const auto touches = [&](const ActiveTet& tet) {
      return std::any_of(tet.node.begin(), tet.node.end(),
                         [&](int node) { return block.owns(node); });
    };
    const auto first = std::find_if(mesh.tets.begin(), mesh.tets.end(), touches);
    const auto last = std::find_if(mesh.tets.rbegin(), mesh.tets.rend(), touches).base();
    block.element_begin = static_cast<int>(first - mesh.tets.begin());
    block.element_end = std::max(block.element_begin, static_cast<int>(last - mesh.tets.begin()));
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace traceraft
