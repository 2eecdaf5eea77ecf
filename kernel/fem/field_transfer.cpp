#include "kernel/fem/field_transfer.hpp"

#include <algorithm>

#include "kernel/mesh/nearest_triangle.hpp"

namespace traceraft::fem {
namespace {

// The barycentric coordinates of a point; false if one is below −tolerance.
bool inside(const mesh::ActiveMesh& mesh, const mesh::ActiveTet& tet, const Point& x,
            std::array<double, 4>& at) {
  constexpr double kRoundoff = 1e-9;
  const Point from_first = (x - mesh.position(tet.node[0])) / mesh.cube.h();
  const auto& gradient = mesh.shape(tet).gradients;
  for (int i = 0; i < 4; ++i) {
    at[i] = (i == 0 ? 1 : 0) + gradient.row(i).dot(from_first);
    if (at[i] < -kRoundoff) return false;
  }
  return true;
}

// The number of the node at a lattice point of another mesh; −1: there is none.
int node_at(const mesh::ActiveMesh& mesh, const mesh::CubeMesh& other, std::int64_t id) {
  mesh::Lattice at = other.vertex(id);
  for (std::int64_t& coordinate : at) {
    coordinate *= mesh.cube.cells;
    if (coordinate % other.cells != 0) return -1;
    coordinate /= other.cells;
  }
  const std::int64_t own = mesh.cube.vertex_id(at);
  const auto found = std::lower_bound(mesh.node_id.begin(), mesh.node_id.end(), own);
  if (found == mesh.node_id.end() || *found != own) return -1;
  return static_cast<int>(found - mesh.node_id.begin());
}

// The triangles of the old surface around what is no longer there, as all new nodes are near them.
std::vector<int> triangles_to_search(const SurfaceSpace& from, const SurfaceSpace& to) {
  std::vector<bool> kept(from.mesh.tets.size(), false), near(from.mesh.node_id.size(), false);
  for (const int tet : mesh::same_tetrahedra(to.mesh, from.mesh))
    if (tet >= 0) kept[tet] = true;
  for (std::size_t t = 0; t < kept.size(); ++t)
    if (!kept[t])
      for (const int node : from.mesh.tets[t].node) near[node] = true;
  std::vector<int> triangles;
  for (std::size_t k = 0; k < from.surface.triangles.size(); ++k) {
    const std::array<int, 4>& node = from.mesh.tets[from.surface.triangle_tet[k]].node;
    if (std::any_of(node.begin(), node.end(), [&](int i) { return near[i]; }))
      triangles.push_back(static_cast<int>(k));
  }
  return triangles;
}

}  // namespace

FieldTransfer::FieldTransfer(const SurfaceSpace& from, const SurfaceSpace& to)
    : begin_{0},
      old_area_(from.node_area),
      new_area_(to.node_area),
      area_(to.area),
      ranks_(to.communicator) {
  const mesh::NearestTriangle nearest(from.surface, triangles_to_search(from, to));
  const auto add = [&](int node, double weight) {
    node_.push_back(node);
    weight_.push_back(weight);
  };
  for (int i = 0; i < to.nodes(); ++i) {
    if (const int same = node_at(from.mesh, to.mesh.cube, to.mesh.node_id[i]); same >= 0) {
      add(same, 1);
      ++copied_;
    } else {
      const Point x = to.mesh.position(i);
      const mesh::SurfacePlace place = nearest.find(x).place;
      const mesh::ActiveTet& tet = from.mesh.tets[from.surface.triangle_tet[place.triangle]];
      std::array<double, 4> at;
      if (inside(from.mesh, tet, x, at)) {
        for (std::size_t k = 0; k < 4; ++k) add(tet.node[k], at[k]);
      } else {
        for (std::size_t k = 0; k < 3; ++k) {
          const mesh::CutPoint& cut =
              from.surface.points[from.surface.triangles[place.triangle][k]];
          add(cut.low, place.at[k] * (1 - cut.s));
          add(cut.high, place.at[k] * cut.s);
        }
      }
    }
    begin_.push_back(static_cast<int>(node_.size()));
  }
}

Vec FieldTransfer::field(VecView nodal) const {
  Vec result(new_area_.size());
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    double sum = 0;
    for (int k = begin_[i]; k < begin_[i + 1]; ++k) sum += weight_[k] * nodal[node_[k]];
    result[i] = sum;
  }
  return result;
}

Vec FieldTransfer::state(VecView y) const {
  const Eigen::Index old_nodes = old_area_.size(), nodes = new_area_.size();
  Vec result(2 * nodes);
  Vec c = field(y.head(old_nodes));
  c.array() += (dot(old_area_, y.head(old_nodes)) - ranks_->sum(dot(new_area_, c))) / area_;
  result << c, field(y.tail(old_nodes));
  return result;
}

}  // namespace traceraft::fem
