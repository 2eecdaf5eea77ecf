#include "verification/bench/mesh_run.hpp"

#include <stdexcept>
#include <utility>

#include "kernel/simulation/adapted_mesh.hpp"

namespace traceraft::bench {

MeshRun::MeshRun(const Bench& bench, const MeshRunRequest& request)
    : bench_(bench), request_(request) {
  Vec field;
  if (request_.adaptive) {
    field = begin_adaptive();
  } else {
    on_.space =
        bench_.space(geometry::make_surface(request_.surface), request_.cells, request_.threads);
    field = request_.field(*on_.space);
  }
  on_ = rest_on(on_.space);
  const StartState start = consistent_state(*on_.problem, field);
  require(on_.integrator->start(0, start.y, start.ydot, request_.t_end));
}

Vec MeshRun::begin_adaptive() {
  const geometry::LevelSetPtr surface = geometry::make_surface(request_.surface);
  const auto levels = simulation::levels_that_keep_the_area(*surface, request_.cells);
  if (!levels) throw std::runtime_error("no larger tetrahedra hold the area");
  const fem::RefinementRule rule =
      bench_.refinement_rule(simulation::boundary_rule(request_.model, *levels));
  const auto team = std::make_shared<ThreadTeam>(request_.threads);
  const auto make_space = [&](mesh::ActiveMesh mesh) {
    return std::make_shared<const fem::SurfaceSpace>(surface, std::move(mesh), team,
                                                     std::make_shared<SerialCommunicator>());
  };
  simulation::FieldOnMesh begin =
      simulation::adapted_field(*surface, *levels, rule, make_space, request_.field);
  adaptation_.emplace(std::move(begin.forest), rule,
                      [this](SpacePtr space) { return rest_on(std::move(space)); });
  on_.space = std::move(begin.space);
  return std::move(begin.field);
}

simulation::Discretisation MeshRun::rest_on(SpacePtr space) const {
  simulation::Discretisation on;
  on.problem = bench_.problem(space, request_.model);
  on.observer = std::make_unique<observables::Observer>(*on.problem, space, 1.0);
  on.integrator = bench_.default_integrator(*on.problem, request_.tolerance);
  on.space = std::move(space);
  return on;
}

void MeshRun::step() {
  if (adaptation_) require(adaptation_->before_step(on_));
  require(on_.integrator->advance());
  node_steps_ += on_.space->nodes();
  ++steps_;
}

simulation::RemeshStatistics MeshRun::meshes() const {
  simulation::RemeshStatistics meshes;
  if (adaptation_) meshes = adaptation_->statistics();
  meshes.node_steps = node_steps_;
  meshes.steps = steps_;
  return meshes;
}

}  // namespace traceraft::bench
