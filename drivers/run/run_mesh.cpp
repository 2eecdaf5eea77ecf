#include "drivers/run/run_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/run/checked_options.hpp"
#include "kernel/mesh/lifted_surface.hpp"

namespace traceraft::run {
namespace {

constexpr std::int64_t kFewestCells = 16;  // per edge of the box, of the largest tetrahedra
constexpr double kAreaTolerance = 1e-5;
constexpr int kMostLevels = 6;
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

bool is_adaptive(const config::Configuration& configuration,
                 const problem::CahnHilliardModel& physics, const Communicator& ranks) {
  if (one_of(configuration, &config::RunOptions::mesh, "mesh") == "uniform") return false;
  const std::string where = configuration.where(&config::RunOptions::mesh);
  if (ranks.size() > 1)
    throw InputError(where +
                     ": a mesh follows the boundaries on one rank only; start one, with "
                     "--threads, or choose uniform");
  for (const problem::EffectPtr& effect : physics.effects)
    if (effect->needs_equal_cells())
      throw InputError(where + ": effect " + effect->name() +
                       " draws noise that large cells do not hold; choose uniform");
  return true;
}

mesh::RefinementLevels refinement_levels(const config::Configuration& configuration,
                                         const geometry::LevelSet& surface) {
  const std::int64_t cells = configuration.options().cells;
  const auto given = static_cast<int>(configuration.options().mesh_levels);
  if (given > 0) {
    mesh::require_levels({cells, given});
    return {cells, given};
  }
  for (int levels = kMostLevels; levels > 0; --levels)
    if (cells % (std::int64_t{1} << levels) == 0 && cells >> levels >= kFewestCells &&
        keeps_the_area(surface, {cells, levels}))
      return {cells, levels};
  throw InputError(configuration.where(&config::RunOptions::cells) +
                   ": no tetrahedra larger than "
                   "those of " +
                   std::to_string(cells) +
                   " cells hold the area of this surface; give an even number of more cells, or "
                   "--mesh uniform");
}

fem::RefinementRule refinement_rule(const config::Configuration& configuration,
                                    const mesh::RefinementLevels& levels) {
  return {configuration.options().mesh_threshold, 0, levels.finest_generation()};
}

FieldOnMesh adapted_field(const geometry::LevelSet& surface, const mesh::RefinementLevels& levels,
                          const fem::RefinementRule& rule,
                          const problem::CahnHilliardModel& physics, const MakeSpace& make_space,
                          const std::function<Vec(const fem::SurfaceSpace&)>& make_field) {
  int begin = 0;
  while (begin < levels.finest_generation() && (levels.coarsest_cells() << begin / 3) < kBeginCells)
    begin += 3;
  mesh::RefinementForest forest(surface, levels, begin);
  SpacePtr space = make_space(mesh::build_active_mesh(surface, forest));
  Vec field = make_field(*space);
  // Each round halves the tetrahedra that are too large; the last ones settle the coarse ones.
  for (int round = 0; round < 4 + 2 * levels.levels; ++round) {
    const std::vector<double> indicator =
        fem::boundary_indicator(*space, physics.epsilon / (physics.well.b - physics.well.a), field);
    mesh::RefinementForest next = forest.refined(
        surface, fem::wanted_generations(*space, rule, indicator, forest.leaf_generations()));
    mesh::ActiveMesh mesh = mesh::build_active_mesh(surface, next);
    if (mesh.node_id == space->mesh.node_id) break;
    forest = std::move(next);
    space = make_space(std::move(mesh));
    field = make_field(*space);
  }
  return {std::move(forest), std::move(space), std::move(field)};
}

}  // namespace traceraft::run
