#include "drivers/run/earlier_run.hpp"

#include "drivers/config/config_file.hpp"
#include "drivers/run/run_mesh.hpp"
#include "kernel/fem/field_transfer.hpp"

namespace traceraft::run {
namespace {

Checkpoint last_of(const std::filesystem::path& run_folder) {
  std::error_code unreadable;
  if (!std::filesystem::is_directory(run_folder / "checkpoints", unreadable))
    throw InputError("restart: " + run_folder.string() +
                     " is not the folder of a run: it has no checkpoints");
  Checkpoint checkpoint;
  try {
    checkpoint = CheckpointStore(run_folder / "checkpoints").newest();
  } catch (const IoError& error) {
    throw InputError(std::string("restart: ") + error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    throw InputError(std::string("restart: ") + error.what());
  }
  if (checkpoint.concentration.empty())
    throw InputError("restart: " + run_folder.string() + " is a run of discs, without a field");
  return checkpoint;
}

void require_same_surface(const std::filesystem::path& run_folder,
                          const config::Configuration& theirs, const config::Configuration& ours) {
  for (const char* option : {"surface", "surface-formula"})
    if (theirs.text(option) != ours.text(option))
      throw InputError("restart: " + run_folder.string() + " has " + option + " = '" +
                       theirs.text(option) + "', but this run has '" + ours.text(option) + "'");
}

// The mesh that a run ended on, as a whole on each rank.
std::shared_ptr<const fem::SurfaceSpace> space_of(const config::Configuration& theirs,
                                                  const Checkpoint& checkpoint,
                                                  const fem::SurfaceSpace& ours) {
  const geometry::LevelSetPtr surface = ours.level_set;
  mesh::ActiveMesh mesh =
      checkpoint.forest.empty()
          ? mesh::build_active_mesh(*surface, theirs.options().cells)
          : mesh::build_active_mesh(
                *surface, mesh::RefinementForest(*surface, refinement_levels(theirs, *surface),
                                                 checkpoint.forest));
  return std::make_shared<const fem::SurfaceSpace>(surface, std::move(mesh), ours.team,
                                                   std::make_shared<SerialCommunicator>(),
                                                   ours.mass_stabilisation);
}

// (c, μ) of a concentration.
Vec state_of(const problem::CahnHilliard& problem, VecView c) {
  Vec y(problem.size()), ydot(problem.size());
  y.head(problem.block_size()) = c;
  if (const Status status = problem.consistent_initial_state(0, y, ydot); !status.ok())
    throw InputError("restart: " + status.why);
  return y;
}

}  // namespace

EarlierRun::EarlierRun(const std::filesystem::path& run_folder,
                       const config::Configuration& configuration,
                       const problem::CahnHilliardModel& model)
    : folder_(run_folder),
      model_(model),
      checkpoint_(last_of(run_folder)),
      theirs_(config::read_config_file(run_folder / "config.toml"), {}) {
  require_same_surface(run_folder, theirs_, configuration);
}

Vec EarlierRun::field_on(const fem::SurfaceSpace& space) {
  if (!from_) {
    from_ = space_of(theirs_, checkpoint_, space);
    c_ = concentration_of(checkpoint_, folder_, from_->nodes());
  }
  const fem::FieldTransfer transfer(*from_, space);
  if (space.communicator->sum(transfer.copied_nodes()) == space.totals.nodes &&
      space.totals.nodes == from_->nodes())
    return transfer.field(c_);
  if (state_.size() == 0) state_ = state_of(problem::CahnHilliard(from_, model_), c_);
  const std::shared_ptr<const fem::SurfaceSpace> here(&space, [](const fem::SurfaceSpace*) {});
  const problem::CahnHilliard after(here, model_);
  Vec y = transfer.state(state_);
  if (const Status status = after.fit_concentration(0, y); !status.ok())
    throw InputError("restart: " + status.why);
  return after.c_of(y);
}

}  // namespace traceraft::run
