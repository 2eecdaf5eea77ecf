#include "kernel/mesh/active_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "kernel/core/error.hpp"
#include "kernel/mesh/cut_cells.hpp"

namespace traceraft::mesh {
namespace {

struct GlobalTet {
  std::array<std::int64_t, 4> vertex;  // ascending
  int shape;
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

// The list may name a vertex again and again.
std::vector<std::int64_t> ascending(std::vector<std::int64_t> vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<std::int64_t> vertices_of(const std::vector<GlobalTet>& tets) {
  std::vector<std::int64_t> vertices;
  vertices.reserve(4 * tets.size());
  for (const GlobalTet& tet : tets)
    vertices.insert(vertices.end(), tet.vertex.begin(), tet.vertex.end());
  return ascending(std::move(vertices));
}

// Those of the cut leaves.
std::vector<std::int64_t> vertices_of(const RefinementForest& forest) {
  const CubeMesh lattice = forest.levels().lattice();
  std::vector<bool> seen(forest.vertices().size(), false);
  std::vector<std::int64_t> vertices;
  for (const int leaf : forest.leaf_cells())
    for (const int vertex : forest.cells()[leaf].vertex) {
      if (seen[vertex]) continue;
      seen[vertex] = true;
      vertices.push_back(lattice.vertex_id(forest.vertices()[vertex].at));
    }
  return ascending(std::move(vertices));
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

// Edges ascend in their lower node, then in the higher one. Nodes are numbered by their id here.
void number_edges(ActiveMesh& mesh, std::size_t nodes) {
  const auto low = [](const ActiveTet& tet, std::size_t e) {
    return static_cast<std::size_t>(tet.node[static_cast<std::size_t>(kTetEdges[e][0])]);
  };
  const auto high = [](const ActiveTet& tet, std::size_t e) {
    return tet.node[static_cast<std::size_t>(kTetEdges[e][1])];
  };
  std::vector<int> begin(nodes + 1, 0);  // of the edges of a lower node, each once per tetrahedron
  for (const ActiveTet& tet : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e) ++begin[low(tet, e) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> highs(6 * mesh.tets.size()), next(begin.begin(), begin.end() - 1);
  for (const ActiveTet& tet : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e) highs[next[low(tet, e)]++] = high(tet, e);

  std::vector<int> first_edge(nodes);
  for (std::size_t node = 0; node < nodes; ++node) {
    const auto from = highs.begin() + begin[node], to = highs.begin() + begin[node + 1];
    std::sort(from, to);
    first_edge[node] = static_cast<int>(mesh.edges.size());
    const auto end = std::unique(from, to);
    for (auto at = from; at != end; ++at) mesh.edges.push_back({static_cast<int>(node), *at});
    next[node] = static_cast<int>(end - highs.begin());
  }
  for (ActiveTet& tet : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e) {
      const std::size_t node = low(tet, e);
      const auto from = highs.begin() + begin[node], to = highs.begin() + next[node];
      tet.edge[e] =
          first_edge[node] + static_cast<int>(std::lower_bound(from, to, high(tet, e)) - from);
    }
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

// The six of a cell, in the order of kKuhnCorners.
std::vector<TetShape> shapes_of_a_cell() {
  std::vector<TetShape> shapes;
  for (const auto& corners : kKuhnCorners) {
    const auto at = [&](std::size_t i) { return corner_of({0, 0, 0}, corners[i]); };
    shapes.push_back(tet_shape({at(0), at(1), at(2), at(3)}));
  }
  return shapes;
}

// The mesh of the tetrahedra at the nodes of this rank, in global order; `ids` are their vertices,
// ascending.
ActiveMesh assembled(const geometry::LevelSet& surface, const CubeMesh& cube,
                     std::vector<TetShape> shapes, const std::vector<GlobalTet>& tets,
                     const std::vector<std::int64_t>& ids, const Partition& partition,
                     const Communicator& ranks) {
  ActiveMesh mesh;
  mesh.cube = cube;
  mesh.shapes = std::move(shapes);
  const VertexLookup node(mesh.cube, ids);
  mesh.tets.reserve(tets.size());
  for (const GlobalTet& tet : tets)
    mesh.tets.push_back(
        {{node(tet.vertex[0]), node(tet.vertex[1]), node(tet.vertex[2]), node(tet.vertex[3])},
         {},
         tet.shape});
  number_edges(mesh, ids.size());
  const std::vector<int> owner = number_nodes(mesh, ids, partition, ranks.rank());
  mesh.halo = plan_halo(mesh, owner);
  mesh.phi = nodal_level_set(surface, mesh.cube, mesh.node_id, ranks);
  return mesh;
}

// Numbers shapes in the order in which they are met, after those of a cell.
class ShapeList {
 public:
  int number(const std::array<Lattice, 4>& vertex) {
    std::array<std::int64_t, 9> sides;
    for (std::size_t i = 0; i < 9; ++i) sides[i] = vertex[i / 3 + 1][i % 3] - vertex[0][i % 3];
    const auto [entry, added] = numbers_.try_emplace(sides, static_cast<int>(shapes.size()));
    if (added) shapes.push_back(tet_shape(vertex));
    return entry->second;
  }

  std::vector<TetShape> shapes = shapes_of_a_cell();

 private:
  std::map<std::array<std::int64_t, 9>, int> numbers_;
};

// All bits of a number mixed (the finaliser of SplitMix64; Steele, Lea, Flood, OOPSLA 2014).
std::uint64_t mixed_bits(std::uint64_t bits) {
  bits = (bits ^ bits >> 30) * 0xBF58476D1CE4E5B9U;
  bits = (bits ^ bits >> 27) * 0x94D049BB133111EBU;
  return bits ^ bits >> 31;
}

// Does every cut face belong to two tetrahedra? The hashes of all cancel each other then.
bool is_closed(const ActiveMesh& mesh) {
  std::uint64_t left = 0;
  for (const ActiveTet& tet : mesh.tets)
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      std::uint64_t hash = 0;
      int below = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i == opposite) continue;
        hash = mixed_bits(hash + static_cast<std::uint64_t>(tet.node[i]) + 1);
        below += mesh.phi[tet.node[i]] < 0;
      }
      if (below != 0 && below != 3) left ^= hash;
    }
  return left == 0;
}

}  // namespace

ActiveMesh build_active_mesh(const geometry::LevelSet& surface, std::int64_t cells,
                             const Communicator& ranks) {
  const CubeMesh cube{cells};
  const Partition partition(surface, cube, ranks.size());
  const std::vector<GlobalTet> cut = find_cut_tets(surface, cube, partition, ranks);
  require_outside(surface, cube);
  if (!ranks.all(!cut.empty()))
    throw InputError(std::to_string(ranks.size()) + " ranks are too many for a mesh of " +
                     std::to_string(cells) + " cells per edge; use fewer ranks or more cells");
  return assembled(surface, cube, shapes_of_a_cell(), cut, vertices_of(cut), partition, ranks);
}

ActiveMesh build_active_mesh(const geometry::LevelSet& surface, const RefinementForest& forest) {
  const CubeMesh cube = forest.levels().lattice();
  ShapeList list;
  std::vector<GlobalTet> tets;
  tets.reserve(forest.leaf_cells().size());
  for (const int leaf : forest.leaf_cells()) {
    std::array<Lattice, 4> vertex;
    for (std::size_t i = 0; i < 4; ++i)
      vertex[i] = forest.vertices()[forest.cells()[leaf].vertex[i]].at;
    const auto id = [&](const Lattice& at) { return cube.vertex_id(at); };
    std::sort(vertex.begin(), vertex.end(),
              [&](const Lattice& a, const Lattice& b) { return id(a) < id(b); });
    tets.push_back(
        {{id(vertex[0]), id(vertex[1]), id(vertex[2]), id(vertex[3])}, list.number(vertex)});
  }
  require_outside(surface, cube);
  ActiveMesh mesh =
      assembled(surface, cube, std::move(list.shapes), tets, vertices_of(forest), {}, kAlone);
  if (!is_closed(mesh))
    throw InputError("mesh-levels: the largest tetrahedra, " +
                     std::to_string(forest.levels().coarsest_cells()) +
                     " per edge of the box, are too coarse for this surface; use fewer levels");
  return mesh;
}

std::vector<int> same_tetrahedra(const ActiveMesh& mesh, const ActiveMesh& earlier) {
  std::vector<int> same(mesh.tets.size(), -1);
  if (mesh.cube.cells != earlier.cube.cells) return same;
  std::vector<int> node(mesh.node_id.size(), -1);  // in the earlier mesh
  for (std::size_t i = 0, k = 0; i < node.size(); ++i) {
    while (k < earlier.node_id.size() && earlier.node_id[k] < mesh.node_id[i]) ++k;
    if (k < earlier.node_id.size() && earlier.node_id[k] == mesh.node_id[i] &&
        earlier.phi[k] == mesh.phi[i])
      node[i] = static_cast<int>(k);
  }
  // Both lists ascend.
  std::size_t at = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<int, 4> wanted;
    for (std::size_t i = 0; i < 4; ++i) wanted[i] = node[mesh.tets[t].node[i]];
    if (std::find(wanted.begin(), wanted.end(), -1) != wanted.end()) continue;
    while (at < earlier.tets.size() && earlier.tets[at].node < wanted) ++at;
    if (at < earlier.tets.size() && earlier.tets[at].node == wanted) same[t] = static_cast<int>(at);
  }
  return same;
}

}  // namespace traceraft::mesh
