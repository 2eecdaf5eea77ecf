// A mesh that follows the boundaries beside uniform ones: when the smaller of two rafts vanishes,
// and what that takes.
#include "kernel/core/stopwatch.hpp"
#include "verification/bench/mesh_run.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

struct Sizes {
  double epsilon;
  int cells, fine_cells;
  double t_end;
};

struct Outcome {
  double vanishes;  // the time at which one raft is left
  double seconds;
  simulation::RemeshStatistics meshes;

  double nodes() const { return meshes.node_steps / meshes.steps; }
  double steps_per_remesh() const {
    const double step = (seconds - meshes.seconds) / meshes.steps;
    return meshes.seconds / static_cast<double>(meshes.remeshes) / step;
  }
};

Vec two_rafts(const fem::SurfaceSpace& space, double epsilon) {
  constexpr double kDegree = kPi / 180;
  problem::InitialRequest request;
  request.caps = {{{0, 0, 1}, 26 * kDegree}, {{0, 0, -1}, 20 * kDegree}};
  request.epsilon = epsilon;
  return problem::make_initial_field("caps", space, request);
}

// Until the smaller raft has vanished.
Outcome followed(const bench::Bench& bench, const Sizes& sizes, int cells, bool adaptive) {
  const Stopwatch watch;
  bench::MeshRunRequest request;
  request.model = bench::bench_model("degenerate", sizes.epsilon);
  request.cells = cells;
  request.adaptive = adaptive;
  request.tolerance = 5e-4;
  request.t_end = sizes.t_end;
  request.field = [&](const fem::SurfaceSpace& space) { return two_rafts(space, sizes.epsilon); };
  bench::MeshRun run(bench, request);
  const auto rafts = [&] {
    const time::Integrator& integrator = *run.on().integrator;
    return run.on().observer->measure(integrator.time(), integrator.state()).rafts;
  };
  do run.step();
  while (rafts() > 1 && !run.finished());
  return {run.on().integrator->time(), watch.seconds(), run.meshes()};
}

StudyReport run(const bench::Bench& bench) {
  const Sizes sizes = bench.quick() ? Sizes{0.05, 64, 96, 200} : Sizes{0.02, 128, 256, 4000};
  StudyReport report;
  report.tables = {{"meshes",
                    {"mesh", "h/epsilon", "nodes", "steps", "remeshes", "seconds",
                     "remesh, in steps", "smaller raft vanishes"},
                    {}}};
  const auto row = [&](const char* name, int cells, const Outcome& outcome) {
    const double h = mesh::CubeMesh{cells}.h();
    const bool follows = outcome.meshes.remeshes > 0;
    report.tables[0].rows.push_back({name, h / sizes.epsilon, outcome.nodes(), outcome.meshes.steps,
                                     static_cast<double>(outcome.meshes.remeshes), outcome.seconds,
                                     follows ? outcome.steps_per_remesh() : 0.0, outcome.vanishes});
  };
  const Outcome uniform = followed(bench, sizes, sizes.cells, false);
  row("uniform", sizes.cells, uniform);
  bench.progress(0.15);
  const Outcome adaptive = followed(bench, sizes, sizes.cells, true);
  row("adaptive", sizes.cells, adaptive);
  bench.progress(0.2);
  const Outcome fine = followed(bench, sizes, sizes.fine_cells, false);
  row("uniform", sizes.fine_cells, fine);
  bench.progress(0.85);
  const Outcome fine_adaptive = followed(bench, sizes, sizes.fine_cells, true);
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
