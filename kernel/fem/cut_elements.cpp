#include "kernel/fem/cut_elements.hpp"

namespace traceraft::fem {
namespace {

Eigen::Matrix<double, 4, 3> basis_gradients(const mesh::ActiveMesh& mesh,
                                            const mesh::ActiveTet& tet) {
  return mesh.shape(tet).gradients / mesh.cube.h();
}

}  // namespace

std::vector<CutElement> find_cut_elements(const mesh::ActiveMesh& mesh) {
  std::vector<CutElement> elements;
  elements.reserve(mesh.tets.size());
  int triangle = 0;
  for (const mesh::ActiveTet& tet : mesh.tets) {
    CutElement element{};
    element.node = tet.node;
    element.edge = tet.edge;
    element.shape = tet.shape;
    const mesh::CutPolygon polygon = mesh::cut_polygon(mesh, tet);
    element.corners = polygon.count;
    for (int v = 0; v < polygon.count; ++v)
      element.cut_edge[v] = static_cast<signed char>(polygon.edge[v]);
    element.first_triangle = triangle;
    triangle += element.triangles();
    elements.push_back(element);
  }
  return elements;
}

void set_metric(const mesh::ActiveMesh& mesh, const mesh::ActiveTet& tet,
                const std::array<mesh::LiftedTriangle, 2>& lifted, CutElement& element) {
  Eigen::Matrix3d inverse_metric = Eigen::Matrix3d::Zero();
  for (int t = 0; t < element.triangles(); ++t) {
    element.area += lifted[t].area;
    inverse_metric += lifted[t].area * lifted[t].inverse_metric;
  }
  const auto gradient = basis_gradients(mesh, tet);
  const Eigen::Matrix4d products =
      gradient * (inverse_metric / element.area) * gradient.transpose();
  for (int e = 0; e < 6; ++e)
    element.coupling[e] = products(mesh::kTetEdges[e][0], mesh::kTetEdges[e][1]);
}

std::array<double, 6> normal_coupling(const mesh::ActiveMesh& mesh, const mesh::ActiveTet& tet) {
  const mesh::TetShape& shape = mesh.shape(tet);
  const double h = mesh.cube.h(), volume = h * h * h * shape.six_volumes / 6;
  const Eigen::Vector4d along = basis_gradients(mesh, tet) * mesh::cut_normal(mesh, tet);
  std::array<double, 6> coupling;
  for (int e = 0; e < 6; ++e)
    coupling[e] = volume * along[mesh::kTetEdges[e][0]] * along[mesh::kTetEdges[e][1]];
  return coupling;
}

Eigen::Matrix4d trace_matrix(const mesh::CutSurface& surface, const CutElement& element) {
  Eigen::Matrix4d trace = Eigen::Matrix4d::Zero();
  for (int t = 0; t < element.triangles(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int corner = kPolygonTriangles[t][k];
      const auto& [low, high] = mesh::kTetEdges[element.cut_edge[corner]];
      const double s = surface.points[surface.triangles[element.first_triangle + t][k]].s;
      trace(corner, low) = 1 - s;
      trace(corner, high) = s;
    }
  return trace;
}

TraceMoments trace_moments(const mesh::CutSurface& surface, const CutElement& element) {
  // A flat triangle adds (1 + δ_ab)/12 between two corners.
  Eigen::Matrix4d at_corners = Eigen::Matrix4d::Zero();
  for (int t = 0; t < element.triangles(); ++t) {
    const double share = surface.triangle_area[element.first_triangle + t] / element.area;
    for (const int a : kPolygonTriangles[t])
      for (const int b : kPolygonTriangles[t]) at_corners(a, b) += share / (a == b ? 6 : 12);
  }
  const Eigen::Matrix4d nodal = trace_matrix(surface, element);
  const Eigen::Matrix4d at_nodes = nodal.transpose() * at_corners * nodal;
  TraceMoments moments{};
  for (int i = 0; i < 4; ++i) {
    moments.mean[i] = at_nodes.row(i).sum();  // the φ_j add up to 1
    moments.mass[i] = at_nodes(i, i);
  }
  for (int e = 0; e < 6; ++e)
    moments.mass[4 + e] = at_nodes(mesh::kTetEdges[e][0], mesh::kTetEdges[e][1]);
  return moments;
}

EdgeCouplings build_edge_couplings(const std::vector<CutElement>& elements, std::size_t edges) {
  EdgeCouplings result;
  result.begin.assign(edges + 1, 0);
  for (const CutElement& element : elements)
    for (const int edge : element.edge) ++result.begin[edge + 1];
  for (std::size_t e = 0; e < edges; ++e) result.begin[e + 1] += result.begin[e];
  result.element.resize(6 * elements.size());
  result.coupling.resize(6 * elements.size());
  std::vector<int> next = result.begin;
  for (std::size_t t = 0; t < elements.size(); ++t)
    for (int k = 0; k < 6; ++k) {
      const int at = next[elements[t].edge[k]]++;
      result.element[at] = static_cast<int>(t);
      result.coupling[at] = elements[t].coupling[k];
    }
  return result;
}

}  // namespace traceraft::fem
