// Everything about the cut tetrahedra that assembly needs, computed once.
#pragma once

#include <array>
#include <vector>

#include "kernel/mesh/lifted_surface.hpp"

namespace traceraft::fem {

// On a tetrahedron ∇c_h is constant and Γ_h is one or two flat triangles, so every weighted
// stiffness matrix is (∫ weight) times the same 4×4 matrix. Integrals are those over the triangles'
// images on Γ.
struct CutElement {
  std::array<int, 4> node;
  std::array<int, 6> edge;              // active edges, order of kTetEdges
  std::array<double, 6> coupling;       // ∇_Γλ_i·∇_Γλ_j of the edges; rows sum to zero
  double area;                          // |Γ_T|, of the images
  int first_triangle;                   // of Γ_h; the second, if there is one, follows
  int corners;                          // of the polygon: 3 or 4
  std::array<signed char, 4> cut_edge;  // local edges at the polygon's corners
  int shape;                            // number in ActiveMesh::shapes
  int triangles() const { return corners - 2; }
};

// The polygon's corners that triangle 0 and 1 of an element join, in the order of CutSurface.
inline constexpr std::array<std::array<int, 3>, 2> kPolygonTriangles = {{{0, 1, 2}, {0, 2, 3}}};

// The polygons of all elements; their areas and couplings are still to be set.
std::vector<CutElement> find_cut_elements(const mesh::ActiveMesh& mesh);
// Sets area and couplings, from the images of the element's triangles.
void set_metric(const mesh::ActiveMesh& mesh, const mesh::ActiveTet& tet,
                const std::array<mesh::LiftedTriangle, 2>& lifted, CutElement& element);

// ∫_T (n·∇λ_i)(n·∇λ_j) dx of the edges of a tetrahedron: the element matrix of S off the diagonal.
std::array<double, 6> normal_coupling(const mesh::ActiveMesh& mesh, const mesh::ActiveTet& tet);

// Integrals of the basis functions over Γ_T, divided by |Γ_T|. Pairs are those of each node with
// itself, then those of kTetEdges. The mean could be summed up from the mass; a run takes 3 %
// longer then.
struct TraceMoments {
  std::array<double, 4> mean;   // ∫ φ_i
  std::array<double, 10> mass;  // ∫ φ_i φ_j
};
TraceMoments trace_moments(const mesh::CutSurface& surface, const CutElement& element);

// The traces at the polygon's corners (rows) of the element's four basis functions (columns).
Eigen::Matrix4d trace_matrix(const mesh::CutSurface& surface, const CutElement& element);

// The elements that contain an edge, and how strongly they couple its ends: with an integral I_T
// for each element, ∫ weight ∇_Γφ_low·∇_Γφ_high = Σ_T coupling · I_T.
struct EdgeCouplings {
  std::vector<int> begin;  // per edge, and the end
  std::vector<int> element;
  std::vector<double> coupling;
};
EdgeCouplings build_edge_couplings(const std::vector<CutElement>& elements, std::size_t edges);

}  // namespace traceraft::fem
