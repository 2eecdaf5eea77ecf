// The trace finite element space of one surface: mesh, cached geometry, sparsity pattern and the
// matrices that do not depend on the solution. Built once, passed on by const reference.
#pragma once

#include <memory>
#include <vector>

#include "kernel/core/communicator.hpp"
#include "kernel/core/global_order.hpp"
#include "kernel/core/status.hpp"
#include "kernel/core/thread_team.hpp"
#include "kernel/fem/csr.hpp"
#include "kernel/fem/row_blocks.hpp"
#include "kernel/mesh/active_mesh.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::fem {

// How much of h S regularises the mass matrix. S adds to the mass of short waves, which slows them:
// with 1, as in the paper's code, K/M of a wave of 3 h is 10 % too small, with 0.3 5 % too large
// (docs/decisions/0019).
inline constexpr double kMassStabilisation = 0.3;

class SurfaceSpace {
  struct Geometry;

 public:
  // On a mesh of the surface. Throws InputError when it is too coarse, or the level set has no
  // gradient on its surface. `mass_stabilisation`: of M̃, in units of h.
  SurfaceSpace(geometry::LevelSetPtr level_set, mesh::ActiveMesh mesh,
               std::shared_ptr<const ThreadTeam> team,
               std::shared_ptr<const Communicator> communicator,
               double mass_stabilisation = kMassStabilisation);
  // On all cut cells, of one size. Throws InputError, too, when the surface is not closed inside
  // the box.
  SurfaceSpace(geometry::LevelSetPtr level_set, std::int64_t cells,
               std::shared_ptr<const ThreadTeam> team,
               std::shared_ptr<const Communicator> communicator,
               double mass_stabilisation = kMassStabilisation);
  // The same surface on another mesh. What both have in common is taken over, bit by bit what it
  // would be without: integrals over tetrahedra that are there again.
  SurfaceSpace(const SurfaceSpace& earlier, mesh::ActiveMesh mesh);

  const geometry::LevelSetPtr level_set;
  const mesh::ActiveMesh mesh;
  const mesh::CutSurface surface;
  const std::vector<CutElement> elements;
  const std::vector<TraceMoments> moments;  // of each element
  const EdgeCouplings edge_couplings;
  const std::shared_ptr<const ThreadTeam> team;
  const std::shared_ptr<const Communicator> communicator;
  const std::vector<RowBlock> blocks;  // one per thread
  const PatternPtr pattern;
  const double mass_stabilisation;

  CsrMatrix mass;                     // M_ij = ∫_Γ φ_i φ_j: singular, see stabilised_mass
  CsrMatrix stiffness;                // K_ij = ∫_Γ ∇_Γφ_i·∇_Γφ_j
  CsrMatrix normal_stiffness;         // S_ij = ∫_cut tets (n·∇φ_i)(n·∇φ_j) dx; S·1 = 0
  CsrMatrix stabilised_mass;          // M̃ = M + mass_stabilisation Σ_T h_T S_T
  CsrMatrix graded_normal_stiffness;  // Σ_T (h_T/h)² S_T: S where all tetrahedra are equal
  Vec node_area;                      // w_i = ∫_Γ φ_i, so ∫_Γ c_h = w·c
  double area;                        // Σ w_i: of Γ, by lifted triangles

  // Over all ranks.
  struct Totals {
    std::int64_t nodes, elements, euler_characteristic;
  };
  const Totals totals;
  const GlobalOrder order;  // of the nodes

  double h() const { return mesh.cube.h(); }      // of the smallest cells
  int nodes() const { return mesh.owned_nodes; }  // of this rank
  // Does a triangle count on this rank?
  bool owns_triangle(std::size_t t) const { return mesh.owns(mesh.tets[surface.triangle_tet[t]]); }

  // Local field (ghosts included) of an owned one; refers to `owned` where there are no ghosts.
  Eigen::Ref<const Vec> with_ghosts(VecView owned, Vec& buffer) const {
    return pattern->halo.with_ghosts(owned, buffer);
  }

  // uᵀ A v over all ranks, for owned nodal fields.
  double bilinear(const CsrMatrix& A, VecView u, VecView v) const;
  double quadratic(const CsrMatrix& A, VecView u) const { return bilinear(A, u, u); }
  // ∫_Γ u v over all ranks.
  double inner(VecView u, VecView v) const { return bilinear(mass, u, v); }
  // ∫_Γ c over all ranks.
  double integral(VecView c) const { return communicator->sum(dot(node_area, c)); }

  // Solves A x = b for a symmetric positive definite A by conjugate gradients, to a relative
  // tolerance. A is as well conditioned as M̃ (7–9 after diagonal scaling), or as K + κ² M̃
  // (h^(-2), for which roundoff takes some 30/h iterations).
  Status solve_spd(const CsrMatrix& A, VecView b, VecRef x, double tolerance) const;
  // M̃ x = b, with ∫x = 1ᵀb exactly up to roundoff.
  Status solve_mass(VecView b, VecRef x) const;

 private:
  void assemble_normal_matrices();  // stabilised_mass, too

  SurfaceSpace(geometry::LevelSetPtr level_set, Geometry geometry,
               std::shared_ptr<const ThreadTeam> team,
               std::shared_ptr<const Communicator> communicator, double mass_stabilisation);
};

// Adds the rows of a block that a 4×4 element matrix touches.
void add_element_matrix(const CutElement& element, const Eigen::Matrix4d& local,
                        const RowBlock& block, CsrMatrix& matrix);
// matrix += Σ local(element, number), each row by one thread in element order.
template <class Local>
void add_element_matrices(const SurfaceSpace& space, const Local& local, CsrMatrix& matrix) {
  space.team->run([&](int part) {
    const RowBlock& block = space.blocks[part];
    for (int e = block.touching_elements.begin; e < block.touching_elements.end; ++e)
      add_element_matrix(space.elements[e], local(space.elements[e], e), block, matrix);
  });
}

// Symmetric assembly: values of a matrix from one number per active edge and one per node.
void fill_symmetric(const std::vector<double>& edge, const std::vector<double>& diagonal,
                    CsrMatrix& matrix);
// The same for matrices with A·1 = 0: the diagonal is minus the sum of the row, exactly.
void fill_zero_row_sum(const std::vector<double>& edge, const std::vector<RowBlock>& blocks,
                       const ThreadTeam& team, CsrMatrix& matrix);

}  // namespace traceraft::fem
