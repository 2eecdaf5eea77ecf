#include "kernel/mesh/active_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/mesh/cut_cells.hpp"

namespace traceraft {
namespace {

struct GlobalTet {
  std::array<std::int64_t, 4> vertex;
  int kuhn;
};

void require_outside(const LevelSet& surface, const CubeMesh& mesh) {
  if (surface.value(mesh.position({0, 0, 0})) < 0)
    throw InputError(
        "the level set must be negative inside the surface and positive outside; change its sign");
}

std::vector<GlobalTet> find_cut_tets(const LevelSet& surface, const CubeMesh& mesh) {
  std::vector<GlobalTet> tets;
  for (const std::int64_t id : find_cut_cells(surface, mesh)) {
    std::int64_t vertex[8];
    bool negative[8];
    for (int corner = 0; corner < 8; ++corner) {
      const Lattice v = corner_of(mesh.cell(id), corner);
      vertex[corner] = mesh.vertex_id(v);
      negative[corner] = surface.value(mesh.position(v)) < 0;
    }
    for (int kuhn = 0; kuhn < 6; ++kuhn) {
      const auto& corner = kKuhnCorners[static_cast<std::size_t>(kuhn)];
      int below = 0;
      for (const int c : corner) below += negative[c];
      if (below == 0 || below == 4) continue;
      tets.push_back(
          {{vertex[corner[0]], vertex[corner[1]], vertex[corner[2]], vertex[corner[3]]}, kuhn});
    }
  }
  return tets;
}

std::vector<std::int64_t> collect_vertices(const std::vector<GlobalTet>& tets) {
  std::vector<std::int64_t> vertices;
  vertices.reserve(4 * tets.size());
  for (const GlobalTet& tet : tets)
    vertices.insert(vertices.end(), tet.vertex.begin(), tet.vertex.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<double> nodal_level_set(const LevelSet& surface, const CubeMesh& mesh,
                                    const std::vector<std::int64_t>& node_id) {
  std::vector<double> phi;
  phi.reserve(node_id.size());
  double largest = 0;
  for (const std::int64_t id : node_id) {
    phi.push_back(surface.value(mesh.position(mesh.vertex(id))));
    largest = std::max(largest, std::fabs(phi.back()));
  }
  const double closest = 1e-10 * largest;
  for (double& value : phi)
    if (std::fabs(value) < closest) value = value < 0 ? -closest : closest;
  return phi;
}

// Node indices by vertex id, one short search in the row of the vertex.
class NodeLookup {
 public:
  NodeLookup(const CubeMesh& mesh, const std::vector<std::int64_t>& node_id)
      : row_length_(mesh.cells + 1), node_id_(node_id) {
    const auto rows = static_cast<std::size_t>(row_length_ * row_length_);
    row_begin_.assign(rows + 1, 0);
    for (const std::int64_t id : node_id)
      ++row_begin_[static_cast<std::size_t>(id / row_length_) + 1];
    for (std::size_t row = 0; row < rows; ++row) row_begin_[row + 1] += row_begin_[row];
  }
  int operator()(std::int64_t id) const {
    const auto row = static_cast<std::size_t>(id / row_length_);
    const auto begin = node_id_.begin() + row_begin_[row];
    const auto end = node_id_.begin() + row_begin_[row + 1];
    return static_cast<int>(std::lower_bound(begin, end, id) - node_id_.begin());
  }

 private:
  std::int64_t row_length_;
  const std::vector<std::int64_t>& node_id_;
  std::vector<int> row_begin_;
};

// A Kuhn edge is its smaller node and one of seven directions, so edges are numbered without a
// sort.
void number_edges(ActiveMesh& mesh) {
  const auto key = [](const ActiveTet& tet, std::size_t e) {
    const auto& corner = kKuhnCorners[static_cast<std::size_t>(tet.kuhn)];
    const auto low = static_cast<std::size_t>(kTetEdges[e][0]);
    const auto high = static_cast<std::size_t>(kTetEdges[e][1]);
    const int direction = corner[high] - corner[low];  // 1 … 7
    return static_cast<std::size_t>(7 * tet.node[low] + direction - 1);
  };
  std::vector<int> high_node(7 * mesh.node_id.size(), -1);
  for (const ActiveTet& tet : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e)
      high_node[key(tet, e)] = tet.node[static_cast<std::size_t>(kTetEdges[e][1])];
  std::vector<int> number(high_node.size(), -1);
  for (std::size_t k = 0; k < high_node.size(); ++k) {
    if (high_node[k] < 0) continue;
    number[k] = static_cast<int>(mesh.edges.size());
    mesh.edges.push_back({static_cast<int>(k / 7), high_node[k]});
  }
  for (ActiveTet& tet : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e) tet.edge[e] = number[key(tet, e)];
}

}  // namespace

ActiveMesh build_active_mesh(const LevelSet& surface, std::int64_t cells) {
  ActiveMesh mesh;
  mesh.cube = {cells};
  const std::vector<GlobalTet> cut = find_cut_tets(surface, mesh.cube);
  require_outside(surface, mesh.cube);
  mesh.node_id = collect_vertices(cut);
  mesh.owned_nodes = mesh.nodes();
  mesh.phi = nodal_level_set(surface, mesh.cube, mesh.node_id);
  const NodeLookup node(mesh.cube, mesh.node_id);
  mesh.tets.reserve(cut.size());
  for (const GlobalTet& tet : cut)
    mesh.tets.push_back(
        {{node(tet.vertex[0]), node(tet.vertex[1]), node(tet.vertex[2]), node(tet.vertex[3])},
         {},
         tet.kuhn});
  number_edges(mesh);
  return mesh;
}

Eigen::Matrix<double, 4, 3> scaled_gradients(int kuhn) {
  // With the axes in the order p of the permutation: λ0 = 1 − ξ_p0, λ1 = ξ_p0 − ξ_p1, …, λ3 = ξ_p2.
  const auto& axis = kKuhnPermutations[static_cast<std::size_t>(kuhn)];
  Eigen::Matrix<double, 4, 3> gradients = Eigen::Matrix<double, 4, 3>::Zero();
  for (int i = 0; i < 3; ++i) {
    gradients(i, axis[static_cast<std::size_t>(i)]) -= 1;
    gradients(i + 1, axis[static_cast<std::size_t>(i)]) += 1;
  }
  return gradients;
}

}  // namespace traceraft
