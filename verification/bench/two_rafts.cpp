#include "verification/bench/two_rafts.hpp"

#include <stdexcept>

#include "kernel/core/stopwatch.hpp"

namespace traceraft::bench {
namespace {

Vec two_caps(const fem::SurfaceSpace& space, const TwoRaftsRequest& asked) {
  constexpr double kDegree = kPi / 180;
  problem::InitialRequest request;
  const Point axis = asked.axis.normalized();
  request.caps = {{axis, 26 * kDegree}, {-axis, 20 * kDegree}};
  request.epsilon = asked.epsilon;
  return problem::make_initial_field("caps", space, request);
}

}  // namespace

double TwoRafts::steps_per_remesh() const {
  const double step = (seconds - meshes.seconds) / meshes.steps;
  return meshes.seconds / static_cast<double>(meshes.remeshes) / step;
}

TwoRafts follow_two_rafts(const Bench& bench, const TwoRaftsRequest& request) {
  const Stopwatch watch;
  MeshRunRequest on_mesh;
  on_mesh.model = bench_model("degenerate", request.epsilon);
  on_mesh.cells = request.cells;
  on_mesh.adaptive = request.adaptive;
  on_mesh.threads = request.threads;
  on_mesh.tolerance = kTwoRaftsTolerance;
  on_mesh.t_end = request.t_end;
  on_mesh.field = [&](const fem::SurfaceSpace& space) { return two_caps(space, request); };
  MeshRun run(bench, on_mesh);
  const auto rafts = [&] {
    const time::Integrator& integrator = *run.on().integrator;
    return run.on().observer->measure(integrator.time(), integrator.state()).rafts;
  };
  int left = 0;
  do {
    run.step();
    left = rafts();
  } while (left > 1 && !run.finished());
  if (left > 1) throw std::runtime_error("the smaller of two rafts is still there at the end");
  return {run.on().integrator->time(), watch.seconds(), run.meshes()};
}

}  // namespace traceraft::bench
