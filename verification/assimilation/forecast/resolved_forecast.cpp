#include "verification/assimilation/forecast/resolved_forecast.hpp"

#include <cmath>

#include "verification/assimilation/forecast/forecast.hpp"

namespace traceraft::assimilation {
namespace {

// Cells of the finer meshes over those of the model's. On the model's own errors may not yet fall
// like h²; on these they do.
constexpr std::array<double, 2> kFiner{1.5, 2.25};

}  // namespace

bench::SpacePtr serial_space(const geometry::LevelSetPtr& surface, int cells,
                             double mass_stabilisation) {
  return std::make_shared<const fem::SurfaceSpace>(surface, cells, std::make_shared<ThreadTeam>(1),
                                                   std::make_shared<SerialCommunicator>(),
                                                   mass_stabilisation);
}

FinerMeshes finer_meshes(const geometry::LevelSetPtr& surface, const bench::SpacePtr& own,
                         int cells) {
  FinerMeshes meshes;
  for (std::size_t m = 0; m < kFiner.size(); ++m)
    meshes.spaces[m] = serial_space(surface, static_cast<int>(std::lround(kFiner[m] * cells)),
                                    own->mass_stabilisation);
  meshes.to_finest = MeshTransfer(*own, meshes.spaces[1]);
  meshes.from_finest = MeshTransfer(*meshes.spaces[1], own);
  meshes.up = MeshTransfer(*meshes.spaces[0], meshes.spaces[1]);
  meshes.down = MeshTransfer(*meshes.spaces[1], meshes.spaces[0]);
  return meshes;
}

FinerTraces finer_traces(const FinerMeshes& meshes, const FieldSeries& series) {
  FinerTraces traces;
  for (std::size_t m = 0; m < traces.size(); ++m)
    for (const FieldSnapshot& snapshot : series.snapshots)
      traces[m].push_back(point_trace(*meshes.spaces[m], snapshot.points, kOffSurface));
  return traces;
}

ResolvedForecast::ResolvedForecast(const FinerMeshes& meshes, const FinerTraces& traces,
                                   const problem::CahnHilliardModel& model, Vec c,
                                   const MakeForecaster& make_integrator)
    : meshes_(meshes),
      traces_(traces),
      problems_{problem::CahnHilliard(meshes.spaces[0], model),
                problem::CahnHilliard(meshes.spaces[1], model)},
      make_integrator_(make_integrator),
      c_(std::move(c)) {}

ResolvedForecast::End ResolvedForecast::advance(std::size_t k, double begin, double end,
                                                const MeshTransfer* turn) {
  const std::array<Vec, 2> starts{meshes_.down(c_), c_};
  std::array<Vec, 2> ends;
  for (std::size_t m = 0; m < 2; ++m) {
    const bench::SpacePtr& space = meshes_.spaces[m];
    const auto on_it = [&](const problem::DaeProblem& p) { return make_integrator_(p, *space); };
    ends[m] = forecast(problems_[m], on_it, starts[m], begin, end).end;
  }
  const double ratio = meshes_.spaces[1]->h() / meshes_.spaces[0]->h();
  const double share = ratio * ratio / (1 - ratio * ratio);
  // Both on the coarser of the two: how well it represents a field is no error of the flow, and
  // falls on other points in finer meshes.
  const Vec last = share * (meshes_.down(ends[1]) - ends[0]);
  Vec up = meshes_.up(last);
  c_ = ends[1] + up;
  if (turn) {
    c_ = (*turn)(c_);
    up = (*turn)(up);
  }
  return {meshes_.from_finest(c_), meshes_.from_finest(up), traces_[1][k] * c_,
          turn ? Vec(traces_[1][k] * up) : Vec(traces_[0][k] * last)};
}

}  // namespace traceraft::assimilation
