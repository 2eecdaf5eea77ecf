#include "drivers/run/run_mesh.hpp"

#include "drivers/run/checked_options.hpp"
#include "drivers/run/initial_state.hpp"
#include "kernel/simulation/adapted_mesh.hpp"

namespace traceraft::run {

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
  if (const auto levels = simulation::levels_that_keep_the_area(surface, cells)) return *levels;
  throw InputError(configuration.where(&config::RunOptions::cells) +
                   ": no tetrahedra larger than "
                   "those of " +
                   std::to_string(cells) +
                   " cells hold the area of this surface; give an even number of more cells, or "
                   "--mesh uniform");
}

}  // namespace traceraft::run
