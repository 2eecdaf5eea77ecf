#include "kernel/simulation/adapted_mesh.hpp"

#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/mesh/cut_surface.hpp"
#include "kernel/mesh/lifted_surface.hpp"

namespace traceraft::simulation {
namespace {

constexpr std::int64_t kFewestCells = 16;  // per edge of the box, of the largest tetrahedra
constexpr double kAreaTolerance = 1e-5;
constexpr int kMostLevels = 6;
constexpr double kSettled = 0.98;         // tetrahedra of another mesh, over those of this one
constexpr std::int64_t kBeginCells = 64;  // a mesh that sees rafts of any size that is of interest

double lifted_area(const geometry::LevelSet& surface, const mesh::RefinementLevels& levels,
                   int generation) {
  const mesh::ActiveMesh mesh =
      mesh::build_active_mesh(surface, mesh::RefinementForest(surface, levels, generation));
  const mesh::CutSurface cut = mesh::build_cut_surface(mesh);
  mesh::require_resolution(mesh, cut);
  double area = 0;
  for (const mesh::LiftedTriangle& triangle :
       mesh::lifted_triangles(surface, mesh, cut, ThreadTeam(1)))
    area += triangle.area;
  return area;
}

// Do the largest tetrahedra hold the area of the surface as ones of half the size do?
bool keeps_the_area(const geometry::LevelSet& surface, const mesh::RefinementLevels& levels) {
  try {
    const double coarse = lifted_area(surface, levels, 0), fine = lifted_area(surface, levels, 3);
    return std::fabs(coarse / fine - 1) <= kAreaTolerance;
  } catch (const InputError&) {
    return false;  // too coarse for the surface
  }
}

}  // namespace

fem::RefinementRule boundary_rule(const problem::CahnHilliardModel& model,
                                  const mesh::RefinementLevels& levels, double threshold) {
  return {threshold, model.boundary_width() / (model.well.b - model.well.a),
          levels.finest_generation()};
}

std::optional<mesh::RefinementLevels> levels_that_keep_the_area(const geometry::LevelSet& surface,
                                                                std::int64_t cells) {
  for (int levels = kMostLevels; levels > 0; --levels)
    if (cells % (std::int64_t{1} << levels) == 0 && cells >> levels >= kFewestCells &&
        keeps_the_area(surface, {cells, levels}))
      return mesh::RefinementLevels{cells, levels};
  return std::nullopt;
}

FieldOnMesh adapted_field(const geometry::LevelSet& surface, const mesh::RefinementLevels& levels,
                          const fem::RefinementRule& rule, const MakeSpace& make_space,
                          const std::function<Vec(const fem::SurfaceSpace&)>& make_field) {
  int begin = 0;
  while (begin < levels.finest_generation() && (levels.coarsest_cells() << begin / 3) < kBeginCells)
    begin += 3;
  mesh::RefinementForest forest(surface, levels, begin);
  std::shared_ptr<const fem::SurfaceSpace> space =
      make_space(mesh::build_active_mesh(surface, forest));
  Vec field = make_field(*space);
  // Two or three rounds refine; the last ones settle what is coarse.
  for (int round = 0; round < 4 + 2 * levels.levels; ++round) {
    const std::vector<int> generation = forest.leaf_generations();
    mesh::RefinementForest next =
        forest.refined(surface, fem::wanted_generations(*space, rule, field, generation));
    const double ratio = static_cast<double>(next.leaf_cells().size()) /
                         static_cast<double>(forest.leaf_cells().size());
    if (ratio > kSettled && !fem::too_coarse(*space, rule, field, generation)) break;
    forest = std::move(next);
    space =
        std::make_shared<const fem::SurfaceSpace>(*space, mesh::build_active_mesh(surface, forest));
    field = make_field(*space);
  }
  return {std::move(forest), std::move(space), std::move(field)};
}

}  // namespace traceraft::simulation
