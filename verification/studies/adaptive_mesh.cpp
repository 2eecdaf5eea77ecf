// A mesh that follows the boundaries beside uniform ones: when the smaller of two rafts vanishes,
// and what that takes.
#include "verification/bench/two_rafts.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

struct Sizes {
  double epsilon;
  int cells, fine_cells;
  double t_end;
};

StudyReport run(const bench::Bench& bench) {
  const Sizes sizes = bench.quick() ? Sizes{0.05, 64, 96, 200} : Sizes{0.02, 128, 256, 4000};
  StudyReport report;
  report.tables = {{"meshes",
                    {"mesh", "h/epsilon", "nodes", "steps", "remeshes", "seconds",
                     "remesh, in steps", "smaller raft vanishes"},
                    {}}};
  const auto row = [&](const char* name, int cells, const bench::TwoRafts& outcome) {
    const double h = mesh::CubeMesh{cells}.h();
    const bool follows = outcome.meshes.remeshes > 0;
    report.tables[0].rows.push_back({name, h / sizes.epsilon, outcome.meshes.mean_nodes(),
                                     outcome.meshes.steps,
                                     static_cast<double>(outcome.meshes.remeshes), outcome.seconds,
                                     follows ? outcome.steps_per_remesh() : 0.0, outcome.vanishes});
  };
  const auto followed = [&](int cells, bool adaptive) {
    return bench::follow_two_rafts(bench, {sizes.epsilon, cells, adaptive, 1, sizes.t_end});
  };
  const bench::TwoRafts uniform = followed(sizes.cells, false);
  row("uniform", sizes.cells, uniform);
  bench.progress(0.15);
  const bench::TwoRafts adaptive = followed(sizes.cells, true);
  row("adaptive", sizes.cells, adaptive);
  bench.progress(0.2);
  const bench::TwoRafts fine = followed(sizes.fine_cells, false);
  row("uniform", sizes.fine_cells, fine);
  bench.progress(0.85);
  const bench::TwoRafts fine_adaptive = followed(sizes.fine_cells, true);
  row("adaptive", sizes.fine_cells, fine_adaptive);
  report.claims = {claim_near("time of vanishing, adaptive / uniform",
                              adaptive.vanishes / uniform.vanishes, 1, 0.015),
                   claim_near("time of vanishing, adaptive / uniform on a finer mesh",
                              adaptive.vanishes / fine.vanishes, 1, 0.02),
                   claim_near("time of vanishing on the finer mesh, adaptive / uniform",
                              fine_adaptive.vanishes / fine.vanishes, 1, 0.015),
                   claim_at_most("nodes, adaptive / uniform",
                                 adaptive.meshes.mean_nodes() / uniform.meshes.mean_nodes(),
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
