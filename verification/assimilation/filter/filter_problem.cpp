#include "verification/assimilation/filter/filter_problem.hpp"

#include <cmath>

#include "backends/list.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "verification/assimilation/fields/kriging.hpp"
#include "verification/assimilation/fields/outliers.hpp"
#include "verification/assimilation/fields/registration.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::assimilation {
namespace {

// The tolerance of forecasts, over the one that integrators have unless asked. It is far below the
// noise of a measurement.
constexpr double kForecastTolerance = 0.3;
// ida solves corrections of forecasts to this, as the deviance of thousands of values sees what
// they leave. With the default, 5e-2, it is 3 too large in a small case, with 1e-2 0.4.
constexpr double kForecastLinearTolerance = 1e-2;
// The least distance of an outlier from what is around it, in units of the distance of the wells;
// and the share of outliers among the values, beyond which data are refused.
constexpr double kOutlying = 0.2, kMostOutliers = 0.05;
// Passes over the snapshots in which outliers are looked for, at most.
constexpr int kMostNoisePasses = 6;

// The deviation that all values would have if all told as much as they do together. It is the unit
// of the stated deviations, which are taken as relative to each other.
double typical_deviation(const FieldSeries& series) {
  double weights = 0, count = 0;
  for (const FieldSnapshot& snapshot : series.snapshots) {
    weights += snapshot.deviation.cwiseAbs2().cwiseInverse().sum();
    count += static_cast<double>(snapshot.deviation.size());
  }
  return std::sqrt(count / weights);
}

std::vector<NoisyValues> noisy_values(const FilterProblem& data) {
  const double typical = typical_deviation(data.series);
  std::vector<NoisyValues> result;
  for (const FieldSnapshot& snapshot : data.series.snapshots) try {
      result.push_back({point_trace(*data.space, snapshot.points, kOffSurface), snapshot.values,
                        snapshot.deviation / typical});
    } catch (const InputError& error) {
      throw InputError("vesicle " + data.series.vesicle + ", snapshot " +
                       std::to_string(result.size() + 1) + ": " + error.what());
    }
  return result;
}

// The parts of a problem that are common to all vesicles.
FilterProblem on_meshes(const geometry::LevelSetPtr& surface,
                        const problem::CahnHilliardModel& base, int cells, int threads,
                        const FilterSettings& settings) {
  FilterProblem data;
  // On meshes of some thousand nodes threads are better used for different columns and models.
  data.team = std::make_shared<ThreadTeam>(threads);
  data.space = serial_space(surface, cells, base.mass_stabilisation);
  data.sphere = is_sphere(*surface);
  data.finer = std::make_shared<const FinerMeshes>(finer_meshes(surface, data.space, cells));
  data.mass = fem::as_eigen(*data.space, data.space->stabilised_mass);
  data.patterns = std::make_shared<const GapPatterns>(*data.space, settings.gap_degree);
  if (settings.blur > 0) data.blur = std::make_shared<const Blur>(*data.space, settings.blur);
  data.tangent_solver = backends::choose_linear_solver("direct", *data.space).primary;
  data.make_integrator = [name = settings.integrator](const problem::DaeProblem& problem,
                                                      const fem::SurfaceSpace& space) {
    const backends::IntegratorEntry& entry = backends::integrators().find(name);
    time::IntegratorSettings integrator;
    integrator.tolerance = kForecastTolerance * entry.tolerance;
    integrator.method_options["epslin"] = kForecastLinearTolerance;
    return entry.make(problem, backends::choose_linear_solver("block", space), space.team,
                      integrator);
  };
  return data;
}

void refuse_outliers(const FilterProblem& data) {
  std::size_t left = 0;
  for (const FieldSnapshot& snapshot : data.series.snapshots) left += snapshot.points.size();
  const auto outliers = static_cast<double>(data.outliers);
  if (outliers > kMostOutliers * (outliers + static_cast<double>(left)))
    throw InputError(
        "vesicle " + data.series.vesicle + ": " + std::to_string(data.outliers) +
        " values of c are far from all values around them; these are too many for single errors");
}

// The prior of the first field, the noise of those that count, and what is left without outliers.
FieldPrior clean(const FieldSeries& series, const physics::DoubleWell& well, FilterProblem& data) {
  data.series = series;
  FieldPrior prior{};
  std::size_t dropped = 1;
  for (int pass = 0; dropped > 0; ++pass) {
    data.snapshots = noisy_values(data);
    prior = estimate_field(*data.space, data.snapshots.front(), ErrorRequest{}).prior;
    double squares = 0;
    dropped = 0;
    for (std::size_t k = 0; k < data.snapshots.size(); ++k) {
      const FieldEstimate here = estimate_field(*data.space, data.snapshots[k], prior, {});
      if (k < data.train) squares += here.noise * here.noise / static_cast<double>(data.train);
      if (pass < kMostNoisePasses)
        dropped += drop_outliers(data.snapshots[k].trace * here.field,
                                 kOutlying * (well.b - well.a), data.series.snapshots[k]);
    }
    data.noise.assign(data.snapshots.size(), std::sqrt(squares));
    data.outliers += dropped;
    refuse_outliers(data);
  }
  return prior;
}

// The first snapshot has a scale and a zero of its own, too, which the model would take for c.
void add_frame(const FilterSettings& settings, double distance, std::size_t vesicle,
               FieldEstimate& first) {
  Eigen::MatrixXd frame(first.field.size(), kFirstFrame);
  frame << settings.first_gain * first.field,
      Vec::Constant(first.field.size(), settings.first_offset * distance);
  Eigen::MatrixXd errors(first.field.size(), kFirstFrame + first.errors.cols());
  errors << frame, first.errors;
  first.errors = std::move(errors);
  for (Eigen::Index j = 0; j < first.draws.cols(); ++j) {
    const auto amplitude = [&](std::uint64_t of) {
      return normal_random(statistics::fixed_seed::replicate_frames, vesicle,
                           kFirstFrame * static_cast<std::uint64_t>(j) + of);
    };
    first.draws.col(j) += frame * Eigen::Vector2d(amplitude(0), amplitude(1));
  }
}

// The first field, on the model's mesh and on the finest one.
void estimate_first(const problem::CahnHilliardModel& base, const FilterSettings& settings,
                    FilterProblem& data) {
  const ErrorRequest wanted{2 * base.epsilon, settings.rank, settings.replicates, data.vesicle};
  const NoisyValues& measured = data.snapshots.front();
  const fem::SurfaceSpace& finest = *data.finer->spaces[1];
  NoisyValues resolved = measured;
  resolved.trace = data.finer_traces[1].front();
  data.first_noise = data.noise.front();
  if (data.correlation.white()) {
    data.first = estimate_field(*data.space, measured, data.prior, wanted);
    data.first_resolved = estimate_field(finest, resolved, data.prior, {}).field;
  } else {
    const Kriging kriging(*data.space, measured, data.series.snapshots.front().points,
                          {data.noise.front(), data.correlation}, data.prior);
    data.first = kriging.estimate(wanted);
    data.first_resolved = kriging.field_on(finest, resolved.trace);
  }
  add_frame(settings, base.well.b - base.well.a, data.vesicle, data.first);
}

// Fields that a snapshot may look like before it is turned: the field of the one before, and what
// the base model makes of it by then. The latter is left out if the model cannot be advanced so
// far.
std::vector<Vec> expected_fields(const FilterProblem& data, const problem::CahnHilliard& base,
                                 std::size_t snapshot) {
  const NoisyValues& before = data.snapshots[snapshot - 1];
  std::vector<Vec> fields{estimate_field(*data.space, before, data.prior, {}).field};
  try {
    fields.push_back(advanced(data, base, fields[0], data.time(snapshot - 1), data.time(snapshot)));
  } catch (const std::runtime_error&) {
    // D of the base model may be far from that of the data.
  }
  return fields;
}

// Each snapshot against what the one before lets expect, whichever is more like it.
void register_snapshots(const problem::CahnHilliardModel& base, FilterProblem& data) {
  data.turns.assign(data.snapshots.size(), nullptr);
  if (!data.sphere) return;
  const problem::CahnHilliard problem(data.space, base);
  const bench::SpacePtr& finest = data.finer->spaces[1];
  for (std::size_t k = 1; k < data.snapshots.size(); ++k) {
    const FieldSnapshot& snapshot = data.series.snapshots[k];
    Registration best{Eigen::Matrix3d::Identity(), false, -1};
    for (const Vec& field : expected_fields(data, problem, k)) {
      const Registration found =
          register_values(SphereMap(*data.space, field), snapshot.points, snapshot.values);
      if (found.correlation > best.correlation) best = found;
    }
    if (!best.turned) continue;
    const Eigen::Matrix3d& Q = best.rotation;
    data.turns[k] = std::make_shared<const SnapshotTurn>(SnapshotTurn{
        Q, MeshTransfer(*data.space, data.space, Q), MeshTransfer(*finest, finest, Q)});
  }
}

void add_series(const FieldSeries& series, const problem::CahnHilliardModel& base,
                const FilterSettings& settings, FilterProblem& data) {
  data.prior = clean(series, base.well, data);
  data.finer_traces = finer_traces(*data.finer, data.series);
  register_snapshots(base, data);
  set_correlation(settings.correlation, base, settings, data);
}

}  // namespace

Vec advanced(const FilterProblem& data, const problem::CahnHilliard& problem, VecView field,
             double begin, double end) {
  const auto make = [&](const problem::DaeProblem& p) {
    return data.make_integrator(p, *data.space);
  };
  return forecast(problem, make, field, begin, end).end;
}

double count_values(const FilterProblems& data) {
  double count = 0;
  for (const FilterProblem& vesicle : data)
    for (std::size_t k = 1; k < vesicle.train; ++k)
      count += static_cast<double>(vesicle.snapshots[k].values.size());
  return count;
}

void set_correlation(const NoiseCorrelation& correlation, const problem::CahnHilliardModel& base,
                     const FilterSettings& settings, FilterProblem& data) {
  data.correlation = correlation;
  data.whitening.assign(data.snapshots.size(), nullptr);
  const auto lanes = static_cast<std::size_t>(data.team->size());
  data.team->run([&](int lane) {
    for (auto k = static_cast<std::size_t>(lane); k < data.snapshots.size(); k += lanes)
      data.whitening[k] = whitening(data.series.snapshots[k].points, correlation);
  });
  estimate_first(base, settings, data);
}

FilterProblems make_filter_problems(const std::vector<FieldSeries>& series,
                                    const geometry::LevelSetPtr& surface,
                                    const problem::CahnHilliardModel& base, int cells, int threads,
                                    bool hold_out, const FilterSettings& settings) {
  FilterProblems problems(series.size(), on_meshes(surface, base, cells, threads, settings));
  for (std::size_t v = 0; v < series.size(); ++v) {
    const std::size_t snapshots = series[v].snapshots.size();
    problems[v].vesicle = v;
    problems[v].train = hold_out && snapshots >= 4 ? snapshots - 1 : snapshots;
    add_series(series[v], base, settings, problems[v]);
  }
  return problems;
}

}  // namespace traceraft::assimilation
