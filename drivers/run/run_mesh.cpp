#include "drivers/run/run_mesh.hpp"

#include <algorithm>

#include "backends/ranks.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/initial_state.hpp"
#include "drivers/run/physical_model.hpp"
#include "kernel/mesh/active_mesh.hpp"
#include "kernel/simulation/adapted_mesh.hpp"

namespace traceraft::run {
namespace {

bool asks_adaptive(const config::Configuration& configuration) {
  return one_of(configuration, &config::RunOptions::mesh, "mesh") == "adaptive";
}

// Why no mesh can follow the boundaries, or "".
std::string need_of_equal_cells(const problem::CahnHilliardModel& physics,
                                const Communicator& ranks) {
  if (ranks.size() > 1)
    return "a mesh follows the boundaries on one rank only; start one, with --threads, or choose "
           "uniform";
  for (const problem::EffectPtr& effect : physics.effects)
    if (effect->needs_equal_cells())
      return "effect " + effect->name() +
             " draws noise that large cells do not hold; choose uniform";
  return "";
}

bool can_follow(const config::Configuration& configuration) {
  if (!need_of_equal_cells(physical_model(configuration), *backends::world()).empty()) return false;
  try {
    (void)refinement_levels(configuration, *surface_of(configuration));
    return true;
  } catch (const InputError&) {
    return false;  // an equal mesh is taken, or refused for a better reason
  }
}

}  // namespace

config::Configuration run_configuration(config::GivenValues file,
                                        const config::GivenValues& flags) {
  config::Configuration configuration(file, flags);
  if (is_of_discs(configuration) || !asks_adaptive(configuration) ||
      configuration.given(&config::RunOptions::mesh) || can_follow(configuration))
    return configuration;
  file.merge(config::uniform_mesh());
  return {file, flags};
}

bool is_adaptive(const config::Configuration& configuration,
                 const problem::CahnHilliardModel& physics, const Communicator& ranks) {
  if (!asks_adaptive(configuration)) return false;
  const std::string why = need_of_equal_cells(physics, ranks);
  if (!why.empty()) throw InputError(configuration.where(&config::RunOptions::mesh) + ": " + why);
  return true;
}

void refuse_adaptive_mesh(const config::Configuration& configuration) {
  if (asks_adaptive(configuration))
    throw InputError(
        configuration.where(&config::RunOptions::mesh) +
        ": all meshes of this command have to be equal; choose uniform, and the number "
        "of its cells");
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
  // A surface that no mesh cuts is the better reason. A small mesh sees that.
  with_option_context(configuration, &config::RunOptions::surface, [&] {
    constexpr std::int64_t kFew = 128;
    return mesh::build_active_mesh(surface, std::min(cells, kFew));
  });
  throw InputError(configuration.where(&config::RunOptions::cells) +
                   ": no tetrahedra larger than "
                   "those of " +
                   std::to_string(cells) +
                   " cells hold the area of this surface; give an even number of more cells, or "
                   "--mesh uniform");
}

}  // namespace traceraft::run
