#include "drivers/run/run_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/run/checked_options.hpp"
#include "drivers/run/initial_state.hpp"
#include "kernel/mesh/lifted_surface.hpp"

namespace traceraft::run {
namespace {

constexpr std::int64_t kFewestCells = 16;  // per edge of the box, of the largest tetrahedra
constexpr double kAreaTolerance = 1e-5;
constexpr int kMostLevels = 6;
constexpr double kWorthIt = 0.98;         // tetrahedra of another mesh, over those of this one
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

bool begins_finest(const config::Configuration& configuration) {
  return configuration.options().mesh == "uniform" || !is_given_on_any_mesh(configuration);
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
  return {configuration.options().mesh_threshold, levels.finest_generation()};
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
  // Two or three rounds refine; the last ones settle what is coarse.
  for (int round = 0; round < 4 + 2 * levels.levels; ++round) {
    const std::vector<double> indicator = simulation::boundary_indicator(*space, physics, field);
    const std::vector<int> generation = forest.leaf_generations();
    mesh::RefinementForest next =
        forest.refined(surface, fem::wanted_generations(*space, rule, indicator, generation));
    const double ratio = static_cast<double>(next.leaf_cells().size()) /
                         static_cast<double>(forest.leaf_cells().size());
    if (ratio > kWorthIt && !fem::too_coarse(rule, indicator, generation)) break;
    forest = std::move(next);
    space = make_space(mesh::build_active_mesh(surface, forest));
    field = make_field(*space);
  }
  return {std::move(forest), std::move(space), std::move(field)};
}

}  // namespace traceraft::run
