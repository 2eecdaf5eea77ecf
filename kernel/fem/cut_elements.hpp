// Everything about the cut tetrahedra that assembly needs, computed once.
#pragma once

#include <array>
#include <vector>

#include "kernel/core/thread_team.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft {

// On a tetrahedron ∇c_h is constant and Γ_h is one or two flat triangles, so a weighted stiffness
// matrix is (mean weight) · K_T and any ∫ f(c_h) v needs only the traces at the polygon's vertices.
struct CutElement {
  std::array<int, 4> node;
  std::array<int, 6> edge;              // active edges, order of kTetEdges
  std::array<double, 6> stiffness;      // K_T off the diagonal: |Γ_T| ∇_Γλ_i·∇_Γλ_j
  std::array<double, 6> normal;         // S_T off the diagonal: |T| (n·∇λ_i)(n·∇λ_j)
  std::array<double, 4> s;              // cut fractions at the polygon's vertices
  std::array<signed char, 4> cut_edge;  // local edges at the polygon's vertices
  std::array<double, 2> triangle_area;  // (0,1,2) and, for quadrilaterals, (0,2,3)
  int corners;                          // 3 or 4
  double area() const { return triangle_area[0] + triangle_area[1]; }
  int triangles() const { return corners - 2; }

  // Traces at the polygon's vertices of a local field given at all nodes.
  std::array<double, 4> trace(ConstVec nodal) const {
    std::array<double, 4> value{};
    for (int v = 0; v < corners; ++v) {
      const auto& [low, high] = kTetEdges[cut_edge[v]];
      value[v] = (1 - s[v]) * nodal[node[low]] + s[v] * nodal[node[high]];
    }
    return value;
  }
  // The transpose: adds vertex loads to the four nodes.
  void distribute(const std::array<double, 4>& load, std::array<double, 4>& nodal) const {
    for (int v = 0; v < corners; ++v) {
      const auto& [low, high] = kTetEdges[cut_edge[v]];
      nodal[low] += (1 - s[v]) * load[v];
      nodal[high] += s[v] * load[v];
    }
  }
};

inline constexpr std::array<std::array<int, 3>, 2> kPolygonTriangles = {{{0, 1, 2}, {0, 2, 3}}};

// The polygon's vertices; the fourth is undefined for triangles.
std::array<Point, 4> corners_of(const ActiveMesh& mesh, const CutElement& element);

std::vector<CutElement> build_cut_elements(const ActiveMesh& mesh);

// Rows [row_begin, row_end) and a range of elements that contains every one touching them. A thread
// computes its own rows from that range and ignores the others, so each row is summed by one thread
// in global element order: the result does not depend on the number of threads (or ranks).
struct RowBlock {
  int row_begin, row_end;
  int element_begin, element_end;
  int edge_begin, edge_end;  // edges whose low node is one of the rows
  bool owns(int row) const { return row >= row_begin && row < row_end; }
};
std::vector<RowBlock> split_rows(const ActiveMesh& mesh, int parts);

// Calls add(row, value) for the four entries that local(element) returns, row by owning thread.
template <class Local, class Add>
void for_each_row_contribution(const std::vector<CutElement>& elements,
                               const std::vector<RowBlock>& blocks, const ThreadTeam& team,
                               const Local& local, const Add& add) {
  team.run([&](int part) {
    const RowBlock& block = blocks[part];
    for (int e = block.element_begin; e < block.element_end; ++e) {
      const CutElement& element = elements[e];
      const std::array<double, 4> value = local(element, e);
      for (int i = 0; i < 4; ++i)
        if (block.owns(element.node[i])) add(element.node[i], value[i]);
    }
  });
}

}  // namespace traceraft
