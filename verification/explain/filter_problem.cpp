#include "verification/explain/filter_problem.hpp"

#include <cmath>

#include "backends/list.hpp"

namespace traceraft {
namespace {

// Of the tolerance that integrators have unless asked: far below the noise of a measurement.
constexpr double kForecastTolerance = 0.3;

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
  const double typical = typical_deviation(series);
  for (const FieldSnapshot& snapshot : series.snapshots) {
    data.times.push_back(snapshot.time);
    data.snapshots.push_back({point_trace(*data.space, snapshot.points, data.space->h()),
                              snapshot.values, snapshot.deviation / typical});
  }
}

// What is common to all vesicles.
FilterProblem on_meshes(const LevelSet& surface, int cells, int threads,
                        const FilterSettings& settings) {
  FilterProblem data;
  // On meshes of some thousand nodes threads are better used for different columns and models.
  data.team = std::make_shared<ThreadTeam>(threads);
  data.space = serial_space(surface, cells);
  data.finer = std::make_shared<const FinerMeshes>(finer_meshes(surface, data.space, cells));
  data.mass = as_eigen(*data.space, data.space->stabilised_mass);
  data.patterns = std::make_shared<const GapPatterns>(*data.space, settings.gap_degree);
  data.tangent_solver = choose_linear_solver("direct", *data.space).primary;
  data.make_integrator = [name = settings.integrator](const DaeProblem& problem,
                                                      const SurfaceSpace& space) {
    const IntegratorEntry& entry = integrators().find(name);
    IntegratorSettings integrator;
    integrator.tolerance = kForecastTolerance * entry.tolerance;
    return entry.make(problem, choose_linear_solver("block", space), space.team, integrator);
  };
  return data;
}

void add_series(const FieldSeries& series, double epsilon, const FilterSettings& settings,
                FilterProblem& data) {
  add_snapshots(series, data);
  data.finer_traces = finer_traces(*data.finer, *data.space, series);
  data.first = estimate_field(*data.space, data.snapshots.front(),
                              {2 * epsilon, settings.rank, settings.replicates, data.vesicle});
  NoisyValues resolved = data.snapshots.front();
  resolved.trace = data.finer_traces[1].front();
  data.first_resolved =
      estimate_field(*data.finer->spaces[1], resolved, data.first.prior, {}).field;
  double squares = 0;
  for (const NoisyValues& values : data.snapshots) {
    const double noise = estimate_field(*data.space, values, data.first.prior, {}).noise;
    squares += noise * noise / static_cast<double>(data.snapshots.size());
  }
  data.noise = std::sqrt(squares);
}

}  // namespace

FilterProblems make_filter_problems(const std::vector<FieldSeries>& series, const LevelSet& surface,
                                    double epsilon, int cells, int threads, bool hold_out,
                                    const FilterSettings& settings) {
  FilterProblems problems(series.size(), on_meshes(surface, cells, threads, settings));
  for (std::size_t v = 0; v < series.size(); ++v) {
    const std::size_t snapshots = series[v].snapshots.size();
    problems[v].vesicle = v;
    problems[v].train = hold_out && snapshots >= 4 ? snapshots - 1 : snapshots;
    add_series(series[v], epsilon, settings, problems[v]);
  }
  return problems;
}

}  // namespace traceraft
