#include "kernel/simulation/mesh_adaptation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "kernel/core/stopwatch.hpp"
#include "kernel/fem/field_transfer.hpp"

namespace traceraft::simulation {
namespace {

// A remesh costs one to two steps. It is worth it where it saves a tenth of the tetrahedra.
constexpr int kStepsBetweenLooks = 15;
constexpr double kWorthIt = 0.9;

// The integrator takes over the run of another one on another mesh. All states move as much as the
// newest has to, so that what is extrapolated from them is as smooth as before.
Status carry(const Discretisation& from, Discretisation& to) {
  const fem::FieldTransfer transfer(*from.space, *to.space);
  const Vec& newest = from.integrator->state();
  const auto difference = [&](VecView y) { return transfer.state(y); };
  const Vec interpolated = difference(newest);
  Vec fitted = interpolated;
  const Status status = to.problem->fit_concentration(from.integrator->time(), fitted);
  if (!status.ok()) return status;
  const Vec shift = fitted - interpolated;
  const CarriedStates carried{
      newest.size(), [&](VecView y) -> Vec { return transfer.state(y) + shift; }, difference};
  std::stringstream stream;
  from.integrator->save(CheckpointOut(stream));
  to.integrator->load(CheckpointIn(stream, carried));
  return {};
}

}  // namespace

MeshAdaptation::MeshAdaptation(mesh::RefinementForest forest, const fem::RefinementRule& rule,
                               MakeRest make_rest)
    : forest_(std::move(forest)),
      generation_(forest_.leaf_generations()),
      rule_(rule),
      make_rest_(std::move(make_rest)) {}

Status MeshAdaptation::before_step(Discretisation& on) {
  const ScopedTimer timer(statistics_.seconds);
  const fem::SurfaceSpace& space = *on.space;
  const VecView c = on.problem->c_of(on.integrator->state());
  statistics_.node_steps += space.nodes();
  ++statistics_.steps;
  const bool must = fem::too_coarse(space, rule_, c, generation_);
  if (!must && ++steps_since_ < kStepsBetweenLooks) return {};
  steps_since_ = 0;
  const std::vector<int> wanted = fem::wanted_generations(space, rule_, c, generation_);
  if (!must && fem::least_share(wanted, generation_) > kWorthIt) return {};
  mesh::RefinementForest forest = forest_.refined(*space.level_set, wanted);
  const double share = static_cast<double>(forest.leaf_cells().size()) /
                       static_cast<double>(forest_.leaf_cells().size());
  if (!must && share > kWorthIt) return {};
  mesh::ActiveMesh mesh = mesh::build_active_mesh(*space.level_set, forest);
  if (mesh.node_id == space.mesh.node_id && mesh.tets.size() == space.mesh.tets.size()) return {};
  return move_to(on, std::move(forest), std::move(mesh));
}

Status MeshAdaptation::move_to(Discretisation& on, mesh::RefinementForest forest,
                               mesh::ActiveMesh mesh) {
  Discretisation next =
      make_rest_(std::make_shared<const fem::SurfaceSpace>(*on.space, std::move(mesh)));
  const double before = on.problem->energy(on.integrator->state());
  try {
    if (Status status = carry(on, next); !status.ok())
      return Status::fatal("the state on a new mesh: " + status.why);
  } catch (const IoError& error) {
    return Status::fatal(std::string("the state on a new mesh: ") + error.what());
  }
  const double after = next.problem->energy(next.integrator->state());
  const double jump =
      (after - before) / std::max(std::fabs(before), on.problem->energy_scale() * 1e-3);
  statistics_.highest_jump = std::max(statistics_.highest_jump, jump);
  statistics_.lowest_jump = std::min(statistics_.lowest_jump, jump);
  ++statistics_.remeshes;
  forest_ = std::move(forest);
  generation_ = forest_.leaf_generations();
  std::swap(on, next);  // integrators go before the problems that they refer to
  return {};
}

void MeshAdaptation::save(CheckpointOut out) const {
  write_binary(out, statistics_);
  write_binary(out, steps_since_);
}

void MeshAdaptation::load(CheckpointIn in) {
  read_binary(in, statistics_);
  read_binary(in, steps_since_);
}

}  // namespace traceraft::simulation
