#include "verification/explain/filter_problem.hpp"

#include <cmath>

#include "backends/list.hpp"

namespace traceraft {
namespace {

// Far below the noise of a measurement.
constexpr double kForecastTolerance = 3e-4;

std::vector<Point> nodes_of(const SurfaceSpace& space) {
  std::vector<Point> nodes;
  for (int k = 0; k < space.nodes(); ++k) nodes.push_back(space.mesh.position(k));
  return nodes;
}

// What data state as their deviations is taken as relative to each other.
double typical_deviation(const FieldSeries& series) {
  double squares = 0, count = 0;
  for (const FieldSnapshot& snapshot : series.snapshots) {
    squares += snapshot.deviation.squaredNorm();
    count += static_cast<double>(snapshot.deviation.size());
  }
  return std::sqrt(squares / count);
}

void add_snapshots(const FieldSeries& series, FilterProblem& data) {
  const double reach = data.space->h(), typical = typical_deviation(series);
  for (const FieldSnapshot& snapshot : series.snapshots) {
    data.times.push_back(snapshot.time);
    data.snapshots.push_back({point_trace(*data.space, snapshot.points, reach), snapshot.values,
                              snapshot.deviation / typical});
    data.fine_trace.push_back(point_trace(*data.fine, snapshot.points, reach));
  }
  // Nodes lie within a cell's diagonal of the surface.
  data.to_fine = point_trace(*data.space, nodes_of(*data.fine), 3 * reach);
  data.from_fine = point_trace(*data.fine, nodes_of(*data.space), 3 * reach);
}

}  // namespace

SpacePtr serial_space(const LevelSet& surface, int cells) {
  return std::make_shared<const SurfaceSpace>(surface, cells, std::make_shared<ThreadTeam>(1),
                                              std::make_shared<SerialCommunicator>());
}

FilterProblem make_filter_problem(const FieldSeries& series, const LevelSet& surface,
                                  double epsilon, int cells, int fine_cells, int threads,
                                  std::size_t held_out, const FilterSettings& settings) {
  FilterProblem data;
  // On meshes of some thousand nodes threads are better used for different columns and models.
  data.team = std::make_shared<ThreadTeam>(threads);
  data.space = serial_space(surface, cells);
  data.fine = serial_space(surface, fine_cells);
  data.mass = as_eigen(*data.space, data.space->stabilised_mass);
  data.patterns = std::make_shared<const GapPatterns>(*data.space, settings.gap_degree);
  data.train = series.snapshots.size() - held_out;
  add_snapshots(series, data);
  data.first = estimate_field(*data.space, data.snapshots.front(),
                              {2 * epsilon, settings.rank, settings.replicates});
  double squares = 0;
  for (const NoisyValues& values : data.snapshots) {
    const double noise = estimate_field(*data.space, values, data.first.prior, {}).noise;
    squares += noise * noise / static_cast<double>(data.snapshots.size());
  }
  data.noise = std::sqrt(squares);
  data.tangent_solver = choose_linear_solver("direct", *data.space).primary;
  data.make_integrator = [](const DaeProblem& problem, const SurfaceSpace& space) {
    IntegratorSettings integrator;
    integrator.tolerance = kForecastTolerance;
    return integrators().find("ida").make(problem, choose_linear_solver("block", space), space.team,
                                          integrator);
  };
  return data;
}

}  // namespace traceraft
