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

// From the entries off the diagonal.
CsrMatrix zero_row_sum_matrix(const SurfaceSpace& space, const std::vector<double>& edge) {
  CsrMatrix matrix(space.pattern);
  fill_zero_row_sum(edge, space.blocks, *space.team, matrix);
  return matrix;
}

CsrMatrix stiffness_matrix(const SurfaceSpace& space) {
  std::vector<double> edge(space.mesh.edges.size(), 0.0);
  for (const CutElement& element : space.elements)
    for (int e = 0; e < 6; ++e) edge[element.edge[e]] += element.coupling[e] * element.area;
  return zero_row_sum_matrix(space, edge);
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
  std::vector<TraceMoments> moments;

  Geometry(const geometry::LevelSet& level_set, mesh::ActiveMesh mesh_, const ThreadTeam& team,
           const Communicator& ranks, const SurfaceSpace* earlier)
      : mesh(std::move(mesh_)),
        surface(checked_surface(level_set, mesh, ranks)),
        elements(find_cut_elements(mesh)),
        moments(elements.size()) {
    const std::vector<int> same = earlier ? mesh::same_tetrahedra(mesh, earlier->mesh)
                                          : std::vector<int>(elements.size(), -1);
    team.for_range(elements.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        if (same[t] < 0)
          integrate(level_set, t);
        else
          take_over(*earlier, same[t], t);
    });
  }

 private:
  void integrate(const geometry::LevelSet& level_set, std::size_t t) {
    CutElement& element = elements[t];
    std::array<mesh::LiftedTriangle, 2> lifted;
    for (int k = 0; k < element.triangles(); ++k)
      lifted[k] = mesh::lifted_triangle(level_set, mesh, surface, element.first_triangle + k);
    set_metric(mesh, mesh.tets[t], lifted, element);
    for (int k = 0; k < element.triangles(); ++k)
      surface.triangle_area[element.first_triangle + k] = lifted[k].area;
    moments[t] = trace_moments(surface, element);
  }

  void take_over(const SurfaceSpace& earlier, int same, std::size_t t) {
    CutElement& element = elements[t];
    const CutElement& known = earlier.elements[same];
    element.area = known.area;
    element.coupling = known.coupling;
    for (int k = 0; k < element.triangles(); ++k)
      surface.triangle_area[element.first_triangle + k] =
          earlier.surface.triangle_area[known.first_triangle + k];
    moments[t] = earlier.moments[same];
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
    : SurfaceSpace(level_set_,
                   Geometry(*level_set_, std::move(mesh_), *team_, *communicator_, nullptr), team_,
                   communicator_, mass_stabilisation_) {}

SurfaceSpace::SurfaceSpace(const SurfaceSpace& earlier, mesh::ActiveMesh mesh_)
    : SurfaceSpace(earlier.level_set,
                   Geometry(*earlier.level_set, std::move(mesh_), *earlier.team,
                            *earlier.communicator, &earlier),
                   earlier.team, earlier.communicator, earlier.mass_stabilisation) {}

SurfaceSpace::SurfaceSpace(geometry::LevelSetPtr level_set_, Geometry geometry,
                           std::shared_ptr<const ThreadTeam> team_,
                           std::shared_ptr<const Communicator> communicator_,
                           double mass_stabilisation_)
    : level_set(std::move(level_set_)),
      mesh(std::move(geometry.mesh)),
      surface(std::move(geometry.surface)),
      elements(std::move(geometry.elements)),
      moments(std::move(geometry.moments)),
      edge_couplings(build_edge_couplings(elements, mesh.edges.size())),
      team(std::move(team_)),
      communicator(std::move(communicator_)),
      blocks(split_rows(mesh, surface, elements, team->size())),
      pattern(build_pattern(mesh, communicator)),
      mass_stabilisation(mass_stabilisation_),
      mass(mass_matrix(*this)),
      stiffness(stiffness_matrix(*this)),
      normal_stiffness(pattern),
      stabilised_mass(pattern),
      graded_normal_stiffness(pattern),
      node_area(Vec::Zero(nodes())),
      totals(totals_of(mesh, surface, *communicator)),
      order({mesh.node_id.begin(), mesh.node_id.begin() + mesh.owned_nodes}, communicator) {
  assemble_normal_matrices();
  mass.multiply(Vec::Ones(mesh.nodes()), node_area, *team);
  area = communicator->sum(node_area.sum());
}

void SurfaceSpace::assemble_normal_matrices() {
  // Σ_T (h_T/h)^k S_T for k = 0, 1, 2, which are one on a uniform mesh.
  std::array<std::vector<double>, 3> edge;
  for (std::vector<double>& values : edge) values.assign(mesh.edges.size(), 0.0);
  for (std::size_t t = 0; t < elements.size(); ++t) {
    std::array<double, 6> value = normal_coupling(mesh, mesh.tets[t]);
    const double size = mesh.shape(mesh.tets[t]).size;
    for (std::vector<double>& values : edge)
      for (int e = 0; e < 6; ++e) {
        values[elements[t].edge[e]] += value[e];
        value[e] *= size;
      }
  }
  normal_stiffness = zero_row_sum_matrix(*this, edge[0]);
  stabilised_mass =
      combine(1.0, mass, mass_stabilisation * h(), zero_row_sum_matrix(*this, edge[1]));
  graded_normal_stiffness = zero_row_sum_matrix(*this, edge[2]);
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
