// A mesh that follows the boundaries beside uniform ones: when the smaller of two rafts vanishes,
// and what that takes.
#include "kernel/core/stopwatch.hpp"
#include "kernel/simulation/adapted_mesh.hpp"
#include "kernel/simulation/mesh_adaptation.hpp"
#include "verification/bench/bench.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

using bench::SpacePtr;
using simulation::Discretisation;

struct Sizes {
  double epsilon;
  int cells, fine_cells;
  double t_end;
};

struct Outcome {
  double vanishes;  // the time at which one raft is left
  double seconds;
  double steps;
  simulation::RemeshStatistics meshes;

  double nodes() const { return meshes.node_steps / meshes.steps; }
  double steps_per_remesh() const {
    const double step = (seconds - meshes.seconds) / steps;
    return meshes.seconds / static_cast<double>(meshes.remeshes) / step;
  }
};

class TwoRafts {
 public:
  TwoRafts(const bench::Bench& bench, const Sizes& sizes)
      : bench_(bench),
        sizes_(sizes),
        model_(bench::bench_model("degenerate", sizes.epsilon)),
        team_(std::make_shared<ThreadTeam>(1)) {}

  Outcome on_uniform(int cells) const {
    const Stopwatch watch;
    const SpacePtr space = bench_.space(surface_, cells, 1);
    return followed(started(space, field_on(*space)), nullptr, watch);
  }
  Outcome on_adaptive(int cells) const {
    const Stopwatch watch;
    const auto levels = simulation::levels_that_keep_the_area(*surface_, cells);
    if (!levels) bench::require(Status::fatal("no larger tetrahedra hold the area"));
    const fem::RefinementRule rule = bench_.refinement_rule(
        {fem::kBoundaryThreshold, model_.boundary_width(), levels->finest_generation()});
    const auto make_space = [this](mesh::ActiveMesh mesh) {
      return std::make_shared<const fem::SurfaceSpace>(surface_, std::move(mesh), team_,
                                                       std::make_shared<SerialCommunicator>());
    };
    simulation::FieldOnMesh start =
        simulation::adapted_field(*surface_, *levels, rule, make_space,
                                  [this](const fem::SurfaceSpace& on) { return field_on(on); });
    simulation::MeshAdaptation adaptation(std::move(start.forest), rule,
                                          [this](SpacePtr space) { return rest_on(space); });
    return followed(started(start.space, start.field), &adaptation, watch);
  }

 private:
  Vec field_on(const fem::SurfaceSpace& space) const {
    constexpr double kDegree = kPi / 180;
    problem::InitialRequest request;
    request.caps = {{{0, 0, 1}, 26 * kDegree}, {{0, 0, -1}, 20 * kDegree}};
    request.epsilon = sizes_.epsilon;
    return problem::make_initial_field("caps", space, request);
  }
  Discretisation rest_on(SpacePtr space) const {
    Discretisation on;
    on.problem = bench_.problem(space, model_);
    on.observer = std::make_unique<observables::Observer>(*on.problem, space, 1.0);
    on.integrator = bench_.default_integrator(*on.problem, 5e-4);
    on.space = std::move(space);
    return on;
  }
  Discretisation started(const SpacePtr& space, VecView field) const {
    Discretisation on = rest_on(space);
    const bench::StartState start = bench::consistent_state(*on.problem, field);
    bench::require(on.integrator->start(0, start.y, start.ydot, sizes_.t_end));
    return on;
  }
  Outcome followed(Discretisation on, simulation::MeshAdaptation* adaptation,
                   const Stopwatch& watch) const {
    double node_steps = 0;
    const auto rafts = [&] {
      return on.observer->measure(on.integrator->time(), on.integrator->state()).rafts;
    };
    do {
      if (adaptation) bench::require(adaptation->before_step(on));
      bench::require(on.integrator->advance());
      node_steps += on.space->nodes();
    } while (rafts() > 1 && on.integrator->time() < sizes_.t_end);
    Outcome outcome{on.integrator->time(),
                    watch.seconds(),
                    static_cast<double>(on.integrator->statistics().steps),
                    {}};
    if (adaptation) outcome.meshes = adaptation->statistics();
    outcome.meshes.node_steps = node_steps;
    outcome.meshes.steps = outcome.steps;
    return outcome;
  }

  const bench::Bench& bench_;
  const Sizes sizes_;
  const problem::CahnHilliardModel model_;
  const std::shared_ptr<const ThreadTeam> team_;
  const geometry::LevelSetPtr surface_ = geometry::make_surface("sphere");
};

StudyReport run(const bench::Bench& bench) {
  const Sizes sizes = bench.quick() ? Sizes{0.05, 64, 96, 200} : Sizes{0.02, 128, 256, 4000};
  const TwoRafts rafts(bench, sizes);
  StudyReport report;
  report.tables = {{"meshes",
                    {"mesh", "h/epsilon", "nodes", "steps", "remeshes", "seconds",
                     "remesh, in steps", "smaller raft vanishes"},
                    {}}};
  const auto row = [&](const char* name, int cells, const Outcome& outcome) {
    const double h = mesh::CubeMesh{cells}.h();
    const bool follows = outcome.meshes.remeshes > 0;
    report.tables[0].rows.push_back({name, h / sizes.epsilon, outcome.nodes(), outcome.steps,
                                     static_cast<double>(outcome.meshes.remeshes), outcome.seconds,
                                     follows ? outcome.steps_per_remesh() : 0.0, outcome.vanishes});
  };
  const Outcome uniform = rafts.on_uniform(sizes.cells);
  row("uniform", sizes.cells, uniform);
  bench.progress(0.15);
  const Outcome adaptive = rafts.on_adaptive(sizes.cells);
  row("adaptive", sizes.cells, adaptive);
  bench.progress(0.2);
  const Outcome fine = rafts.on_uniform(sizes.fine_cells);
  row("uniform", sizes.fine_cells, fine);
  bench.progress(0.85);
  const Outcome fine_adaptive = rafts.on_adaptive(sizes.fine_cells);
  row("adaptive", sizes.fine_cells, fine_adaptive);
  report.claims = {claim_near("time of vanishing, adaptive / uniform",
                              adaptive.vanishes / uniform.vanishes, 1, 0.015),
                   claim_near("time of vanishing, adaptive / uniform on a finer mesh",
                              adaptive.vanishes / fine.vanishes, 1, 0.02),
                   claim_near("time of vanishing on the finer mesh, adaptive / uniform",
                              fine_adaptive.vanishes / fine.vanishes, 1, 0.015),
                   claim_at_most("nodes, adaptive / uniform", adaptive.nodes() / uniform.nodes(),
                                 bench.quick() ? 0.4 : 0.2),
                   claim_at_most("time, adaptive / uniform", adaptive.seconds / uniform.seconds,
                                 bench.quick() ? 0.8 : 0.2)};
  report.notes = {"Two rafts, caps of 26 and 20 degrees, on one core; tolerance 5e-4."};
  return report;
}

}  // namespace

StudyEntry adaptive_mesh_study() {
  return {"adaptive", "a mesh that follows the boundaries beside uniform ones: accuracy and time",
          run, true};
}

}  // namespace traceraft::studies
