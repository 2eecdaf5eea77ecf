#include "kernel/fem/surface_space.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/mesh/gradient_check.hpp"

namespace traceraft::fem {
namespace {

mesh::CutSurface checked_surface(const geometry::LevelSet& level_set, const mesh::ActiveMesh& mesh,
                                 const Communicator& ranks) {
  mesh::CutSurface surface = mesh::build_cut_surface(mesh);
  // A mesh that is too coarse may be so near one place alone.
  mesh::require_gradient(level_set, mesh, surface, 0.5, ranks);
  mesh::require_resolution(mesh, surface, ranks);
  mesh::require_gradient(level_set, mesh, surface, 0, ranks);
  return surface;
}

SurfaceSpace::Totals totals_of(const mesh::ActiveMesh& mesh, const mesh::CutSurface& surface,
                               const Communicator& ranks) {
  const auto elements = std::count_if(mesh.tets.begin(), mesh.tets.end(),
                                      [&](const mesh::ActiveTet& tet) { return mesh.owns(tet); });
  return {std::llround(ranks.sum(mesh.owned_nodes)),
          std::llround(ranks.sum(static_cast<double>(elements))),
          mesh::euler_characteristic(mesh, surface, ranks)};
}

// From the entries off the diagonal, off_diagonal(element number) for the edges of an element.
template <class OffDiagonal>
CsrMatrix zero_row_sum_matrix(const SurfaceSpace& space, const OffDiagonal& off_diagonal) {
  std::vector<double> edge(space.mesh.edges.size(), 0.0);
  for (std::size_t t = 0; t < space.elements.size(); ++t) {
    const std::array<double, 6> value = off_diagonal(t);
    for (int e = 0; e < 6; ++e) edge[space.elements[t].edge[e]] += value[e];
  }
  CsrMatrix matrix(space.pattern);
  fill_zero_row_sum(edge, space.blocks, *space.team, matrix);
  return matrix;
}

CsrMatrix stiffness_matrix(const SurfaceSpace& space) {
  return zero_row_sum_matrix(space, [&](std::size_t t) {
    std::array<double, 6> value = space.elements[t].coupling;
    for (double& entry : value) entry *= space.elements[t].area;
    return value;
  });
}

// Σ_T weight(shape of T) S_T.
template <class Weight>
CsrMatrix normal_matrix(const SurfaceSpace& space, const Weight& weight) {
  return zero_row_sum_matrix(space, [&](std::size_t t) {
    const mesh::ActiveTet& tet = space.mesh.tets[t];
    std::array<double, 6> value = normal_coupling(space.mesh, tet);
    for (double& entry : value) entry *= weight(space.mesh.shape(tet));
    return value;
  });
}

CsrMatrix stabilised_mass_matrix(const SurfaceSpace& space) {
  return combine(1.0, space.mass, space.mass_stabilisation * space.h(),
                 normal_matrix(space, [](const mesh::TetShape& shape) { return shape.size; }));
}

CsrMatrix mass_matrix(const SurfaceSpace& space) {
  std::vector<double> edge(space.mesh.edges.size(), 0.0), diagonal(space.mesh.nodes(), 0.0);
  for (std::size_t t = 0; t < space.elements.size(); ++t) {
    const CutElement& element = space.elements[t];
    const std::array<double, 10>& mass = space.moments[t].mass;
    for (int i = 0; i < 4; ++i) diagonal[element.node[i]] += element.area * mass[i];
    for (int e = 0; e < 6; ++e) edge[element.edge[e]] += element.area * mass[4 + e];
  }
  CsrMatrix matrix(space.pattern);
  fill_symmetric(edge, diagonal, matrix);
  return matrix;
}

}  // namespace

struct SurfaceSpace::Geometry {
  mesh::ActiveMesh mesh;
  mesh::CutSurface surface;
  std::vector<CutElement> elements;

  Geometry(const geometry::LevelSet& level_set, mesh::ActiveMesh mesh_, const ThreadTeam& team,
           const Communicator& ranks)
      : mesh(std::move(mesh_)), surface(checked_surface(level_set, mesh, ranks)) {
    const std::vector<mesh::LiftedTriangle> lifted =
        mesh::lifted_triangles(level_set, mesh, surface, team);
    elements = build_cut_elements(mesh, lifted);
    for (std::size_t t = 0; t < lifted.size(); ++t) surface.triangle_area[t] = lifted[t].area;
  }
};

void add_element_matrix(const CutElement& element, const Eigen::Matrix4d& local,
                        const RowBlock& block, CsrMatrix& matrix) {
  const SparsityPattern& pattern = *matrix.pattern;
  for (int i = 0; i < 4; ++i)
    if (block.rows.contains(element.node[i]))
      matrix.values[pattern.diagonal[element.node[i]]] += local(i, i);
  for (int e = 0; e < 6; ++e) {
    const auto& [i, j] = mesh::kTetEdges[e];
    if (block.rows.contains(element.node[i]))
      matrix.values[pattern.low_high[element.edge[e]]] += local(i, j);
    if (block.rows.contains(element.node[j]))
      matrix.values[pattern.high_low[element.edge[e]]] += local(j, i);
  }
}

CsrMatrix graded_normal_stiffness(const SurfaceSpace& space) {
  return normal_matrix(space, [](const mesh::TetShape& shape) { return shape.size * shape.size; });
}

void fill_symmetric(const std::vector<double>& edge, const std::vector<double>& diagonal,
                    CsrMatrix& matrix) {
  const SparsityPattern& pattern = *matrix.pattern;
  for (int k = 0; k < pattern.entries(); ++k) {
    const int e = pattern.edge_of_entry[k];
    matrix.values[k] = e >= 0 ? edge[e] : diagonal[pattern.column[k]];
  }
}

void fill_zero_row_sum(const std::vector<double>& edge, const std::vector<RowBlock>& blocks,
                       const ThreadTeam& team, CsrMatrix& matrix) {
  const SparsityPattern& pattern = *matrix.pattern;
  team.run([&](int part) {
    for (int i = blocks[part].rows.begin; i < blocks[part].rows.end; ++i) {
      double sum = 0;
      for (int k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k) {
        const int e = pattern.edge_of_entry[k];
        if (e < 0) continue;
        matrix.values[k] = edge[e];
        sum += edge[e];
      }
      matrix.values[pattern.diagonal[i]] = -sum;
    }
  });
}

SurfaceSpace::SurfaceSpace(geometry::LevelSetPtr level_set_, std::int64_t cells,
                           std::shared_ptr<const ThreadTeam> team_,
                           std::shared_ptr<const Communicator> communicator_,
                           double mass_stabilisation_)
    : SurfaceSpace(level_set_, mesh::build_active_mesh(*level_set_, cells, *communicator_), team_,
                   communicator_, mass_stabilisation_) {}

SurfaceSpace::SurfaceSpace(geometry::LevelSetPtr level_set_, mesh::ActiveMesh mesh_,
                           std::shared_ptr<const ThreadTeam> team_,
                           std::shared_ptr<const Communicator> communicator_,
                           double mass_stabilisation_)
    : SurfaceSpace(level_set_, Geometry(*level_set_, std::move(mesh_), *team_, *communicator_),
                   team_, communicator_, mass_stabilisation_) {}

SurfaceSpace::SurfaceSpace(geometry::LevelSetPtr level_set_, Geometry geometry,
                           std::shared_ptr<const ThreadTeam> team_,
                           std::shared_ptr<const Communicator> communicator_,
                           double mass_stabilisation_)
    : level_set(std::move(level_set_)),
      mesh(std::move(geometry.mesh)),
      surface(std::move(geometry.surface)),
      elements(std::move(geometry.elements)),
      moments(build_trace_moments(surface, elements)),
      edge_couplings(build_edge_couplings(elements, mesh.edges.size())),
      team(std::move(team_)),
      communicator(std::move(communicator_)),
      blocks(split_rows(mesh, surface, elements, team->size())),
      pattern(build_pattern(mesh, communicator)),
      mass_stabilisation(mass_stabilisation_),
      mass(mass_matrix(*this)),
      stiffness(stiffness_matrix(*this)),
      normal_stiffness(normal_matrix(*this, [](const mesh::TetShape&) { return 1.0; })),
      stabilised_mass(stabilised_mass_matrix(*this)),
      node_area(Vec::Zero(nodes())),
      totals(totals_of(mesh, surface, *communicator)),
      order({mesh.node_id.begin(), mesh.node_id.begin() + mesh.owned_nodes}, communicator) {
  mass.multiply(Vec::Ones(mesh.nodes()), node_area, *team);
  area = communicator->sum(node_area.sum());
}

double SurfaceSpace::bilinear(const CsrMatrix& A, VecView u, VecView v) const {
  Vec buffer;
  return communicator->sum(A.bilinear(u, with_ghosts(v, buffer), *team));
}

Status SurfaceSpace::solve_spd(const CsrMatrix& A, VecView b, VecRef x, double tolerance) const {
  const auto global_dot = [&](const Vec& u, const Vec& v) { return communicator->sum(dot(u, v)); };
  Vec inverse_diagonal(nodes());
  for (int i = 0; i < nodes(); ++i) inverse_diagonal[i] = 1 / A.values[pattern->diagonal[i]];
  Vec residual = b, preconditioned = inverse_diagonal.cwiseProduct(residual);
  Vec direction = preconditioned, product(nodes()), buffer;
  x.setZero();
  double rho = global_dot(residual, preconditioned);
  const double target = tolerance * tolerance * rho;
  const int most = 500 + static_cast<int>(100 / h());
  for (int iteration = 0; rho > target && iteration < most; ++iteration) {
    A.multiply(with_ghosts(direction, buffer), product, *team);
    const double alpha = rho / global_dot(direction, product);
    x += alpha * direction;
    residual -= alpha * product;
    preconditioned = inverse_diagonal.cwiseProduct(residual);
    const double next = global_dot(residual, preconditioned);
    direction = preconditioned + (next / rho) * direction;
    rho = next;
  }
  if (!(rho <= target)) return Status::fatal("conjugate gradients did not converge");
  return {};
}

Status SurfaceSpace::solve_mass(VecView b, VecRef x) const {
  if (Status status = solve_spd(stabilised_mass, b, x, 1e-14); !status.ok()) return status;
  const double defect = communicator->sum(b.sum()) - integral(x);
  x.array() += defect / area;
  return {};
}

}  // namespace traceraft::fem
