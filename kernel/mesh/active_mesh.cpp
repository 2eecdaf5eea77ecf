#include "kernel/mesh/active_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kernel/core/error.hpp"
#include "kernel/mesh/cut_cells.hpp"

namespace traceraft::mesh {
namespace {

struct GlobalTet {
  std::array<std::int64_t, 4> vertex;
  int kuhn;
};

void require_outside(const geometry::LevelSet& surface, const CubeMesh& mesh) {
  if (surface.value(mesh.position({0, 0, 0})) < 0)
    throw InputError(
        "the level set must be negative inside the surface and positive outside; change its sign");
}

// Those with a node of this rank, in global order.
std::vector<GlobalTet> find_cut_tets(const geometry::LevelSet& surface, const CubeMesh& mesh,
                                     const Partition& partition, const Communicator& ranks) {
  std::vector<GlobalTet> tets;
  for (const std::int64_t id : find_cut_cells(surface, mesh, partition, ranks)) {
    std::int64_t vertex[8];
    bool negative[8], owned[8];
    for (int corner = 0; corner < 8; ++corner) {
      const Lattice v = corner_of(mesh.cell(id), corner);
      vertex[corner] = mesh.vertex_id(v);
      negative[corner] = surface.value(mesh.position(v)) < 0;
      owned[corner] = partition.owner(v) == ranks.rank();
    }
    for (int kuhn = 0; kuhn < 6; ++kuhn) {
      const auto& corner = kKuhnCorners[static_cast<std::size_t>(kuhn)];
      int below = 0;
      for (const int c : corner) below += negative[c];
      if (below == 0 || below == 4) continue;
      if (std::none_of(corner.begin(), corner.end(), [&](int c) { return owned[c]; })) continue;
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

std::vector<double> nodal_level_set(const geometry::LevelSet& surface, const CubeMesh& mesh,
                                    const std::vector<std::int64_t>& node_id,
                                    const Communicator& ranks) {
  std::vector<double> phi;
  phi.reserve(node_id.size());
  double largest = 0;
  for (const std::int64_t id : node_id) {
    phi.push_back(surface.value(mesh.position(mesh.vertex(id))));
    largest = std::max(largest, std::fabs(phi.back()));
  }
  const double closest = 1e-10 * ranks.max(largest);
  for (double& value : phi)
    if (std::fabs(value) < closest) value = value < 0 ? -closest : closest;
  return phi;
}

// Positions in a sorted list of vertex ids, one short search in the row of the vertex.
class VertexLookup {
 public:
  VertexLookup(const CubeMesh& mesh, const std::vector<std::int64_t>& ids)
      : row_length_(mesh.cells + 1), first_row_(ids.front() / row_length_), ids_(ids) {
    const std::int64_t rows = ids.back() / row_length_ - first_row_ + 1;
    row_begin_.assign(static_cast<std::size_t>(rows) + 1, 0);
    for (const std::int64_t id : ids) ++row_begin_[row_of(id) + 1];
    std::partial_sum(row_begin_.begin(), row_begin_.end(), row_begin_.begin());
  }
  int operator()(std::int64_t id) const {
    const auto begin = ids_.begin() + row_begin_[row_of(id)];
    const auto end = ids_.begin() + row_begin_[row_of(id) + 1];
    return static_cast<int>(std::lower_bound(begin, end, id) - ids_.begin());
  }

 private:
  std::size_t row_of(std::int64_t id) const {
    return static_cast<std::size_t>(id / row_length_ - first_row_);
  }

  std::int64_t row_length_, first_row_;
  const std::vector<std::int64_t>& ids_;
  std::vector<int> row_begin_;
};

// A Kuhn edge is its smaller node and one of seven directions, so edges are numbered without a
// sort. Nodes are numbered by their id here.
void number_edges(ActiveMesh& mesh, std::size_t nodes) {
  const auto key = [](const ActiveTet& tet, std::size_t e) {
    const auto& corner = kKuhnCorners[static_cast<std::size_t>(tet.kuhn)];
    const auto low = static_cast<std::size_t>(kTetEdges[e][0]);
    const auto high = static_cast<std::size_t>(kTetEdges[e][1]);
    const int direction = corner[high] - corner[low];  // 1 … 7
    return static_cast<std::size_t>(7 * tet.node[low] + direction - 1);
  };
  std::vector<int> high_node(7 * nodes, -1);
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

// From the order of the ids to the local one: owned nodes, then ghosts by neighbour. Returns the
// owner of every local node.
std::vector<int> number_nodes(ActiveMesh& mesh, const std::vector<std::int64_t>& ids,
                              const Partition& partition, int rank) {
  std::vector<int> owner;
  for (const std::int64_t id : ids) owner.push_back(partition.owner(mesh.cube.vertex(id)));
  std::vector<int> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(owner[a] != rank, owner[a]) < std::pair(owner[b] != rank, owner[b]);
  });
  std::vector<int> local(ids.size()), local_owner;
  for (std::size_t k = 0; k < order.size(); ++k) {
    local[order[k]] = static_cast<int>(k);
    mesh.node_id.push_back(ids[order[k]]);
    local_owner.push_back(owner[order[k]]);
  }
  mesh.owned_nodes = static_cast<int>(std::count(local_owner.begin(), local_owner.end(), rank));
  for (ActiveTet& tet : mesh.tets)
    for (int& node : tet.node) node = local[node];
  for (ActiveEdge& edge : mesh.edges) edge = {local[edge.low], local[edge.high]};
  return local_owner;
}

// A neighbour has those of my nodes as ghosts that share a tetrahedron with one of its own; all
// tetrahedra at my nodes are mine, so that nobody needs to be asked.
HaloPlan plan_halo(const ActiveMesh& mesh, const std::vector<int>& owner) {
  std::vector<std::pair<int, int>> sends;  // neighbour, node
  for (const ActiveTet& tet : mesh.tets)
    for (const int ghost : tet.node)
      if (!mesh.owns(ghost))
        for (const int mine : tet.node)
          if (mesh.owns(mine)) sends.emplace_back(owner[ghost], mine);
  std::sort(sends.begin(), sends.end());
  sends.erase(std::unique(sends.begin(), sends.end()), sends.end());
  HaloPlan plan;
  for (const auto& [rank, node] : sends) {
    if (plan.neighbours.empty() || plan.neighbours.back().rank != rank)
      plan.neighbours.push_back(
          {rank, {}, static_cast<int>(std::count(owner.begin(), owner.end(), rank))});
    plan.neighbours.back().send.push_back(node);
  }
  return plan;
}

}  // namespace

ActiveMesh build_active_mesh(const geometry::LevelSet& surface, std::int64_t cells,
                             const Communicator& ranks) {
  ActiveMesh mesh;
  mesh.cube = {cells};
  const Partition partition(surface, mesh.cube, ranks.size());
  const std::vector<GlobalTet> cut = find_cut_tets(surface, mesh.cube, partition, ranks);
  require_outside(surface, mesh.cube);
  if (!ranks.all(!cut.empty()))
    throw InputError(std::to_string(ranks.size()) + " ranks are too many for a mesh of " +
                     std::to_string(cells) + " cells per edge; use fewer ranks or more cells");
  const std::vector<std::int64_t> ids = collect_vertices(cut);
  const VertexLookup node(mesh.cube, ids);
  mesh.tets.reserve(cut.size());
  for (const GlobalTet& tet : cut)
    mesh.tets.push_back(
        {{node(tet.vertex[0]), node(tet.vertex[1]), node(tet.vertex[2]), node(tet.vertex[3])},
         {},
         tet.kuhn});
  number_edges(mesh, ids.size());
  const std::vector<int> owner = number_nodes(mesh, ids, partition, ranks.rank());
  mesh.halo = plan_halo(mesh, owner);
  mesh.phi = nodal_level_set(surface, mesh.cube, mesh.node_id, ranks);
  return mesh;
}

Eigen::Matrix<double, 4, 3> scaled_gradients(int kuhn) {
  // The barycentric coordinates, with the axes in the order p of the permutation: λ0 = 1 − ξ_p0, λ1
  // = ξ_p0 − ξ_p1, …, λ3 = ξ_p2.
  const auto& axis = kKuhnPermutations[static_cast<std::size_t>(kuhn)];
  Eigen::Matrix<double, 4, 3> gradients = Eigen::Matrix<double, 4, 3>::Zero();
  for (int i = 0; i < 3; ++i) {
    gradients(i, axis[static_cast<std::size_t>(i)]) -= 1;
    gradients(i + 1, axis[static_cast<std::size_t>(i)]) += 1;
  }
  return gradients;
}

}  // namespace traceraft::mesh
