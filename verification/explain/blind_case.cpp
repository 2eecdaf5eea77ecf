#include "verification/explain/blind_case.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "backends/list.hpp"
#include "kernel/core/random.hpp"
#include "verification/explain/forecast.hpp"
#include "verification/explain/point_trace.hpp"

namespace traceraft {
namespace {

// Streams of random numbers: what is drawn for one purpose does not depend on how much is drawn for
// another.
enum Stream : std::uint64_t { kPlacement = 101, kTimes, kPoints, kNoise = 200 };

// Where the vesicle lies in the mesh: turned about the z axis, which effects may know, and moved.
struct Placement {
  double angle;
  Point offset;

  Placement(std::uint64_t seed, double h) {
    const auto u = [&](std::uint64_t i) { return uniform_random(seed, kPlacement, i); };
    angle = 2 * kPi * u(0);
    offset = h * Point(u(1) - 0.5, u(2) - 0.5, u(3) - 0.5);
  }
  Point in_mesh(const Point& x) const {
    return Eigen::AngleAxisd(angle, Point::UnitZ()) * x + offset;
  }
};

// Between `first` and `last`, irregular: equal ratios with a random part of half a ratio.
std::vector<double> snapshot_times(const BlindRequest& request) {
  std::vector<double> times;
  for (int k = 0; k < request.snapshots; ++k) {
    const bool end = k == 0 || k + 1 == request.snapshots;
    const double u = end ? 0 : 0.5 * (uniform_random(request.seed, kTimes, k) - 0.5);
    times.push_back(request.first *
                    std::pow(request.last / request.first, (k + u) / (request.snapshots - 1)));
  }
  return times;
}

std::vector<Point> random_directions(const BlindRequest& request, int snapshot) {
  std::vector<Point> points;
  for (int i = 0; i < request.points; ++i) {
    const auto u = [&](int j) {
      return uniform_random(request.seed, kPoints + static_cast<std::uint64_t>(2 * snapshot + j),
                            i);
    };
    const double z = 2 * u(0) - 1, phi = 2 * kPi * u(1), r = std::sqrt(1 - z * z);
    points.push_back({r * std::cos(phi), r * std::sin(phi), z});
  }
  return points;
}

double spread(const SurfaceSpace& space, ConstVec c) {
  const double mean = space.integral(c) / space.area;
  return std::sqrt(std::max(0.0, space.inner(c, c) / space.area - mean * mean));
}

// The truth and how it is advanced.
class Simulation {
 public:
  Simulation(const BlindRequest& request, SpacePtr space, const std::vector<EffectTerm>& effects)
      : request_(request),
        problem_(space, with_effects(request.base, effects)),
        make_integrator_([&request, space](const DaeProblem& problem) {
          IntegratorSettings settings;
          settings.tolerance = request.tolerance;
          return integrators()
              .find(request.integrator)
              .make(problem, choose_linear_solver("block", *space), space->team, settings);
        }) {}

  // c at the times, which begin after 0.
  std::vector<Vec> run(const std::vector<double>& times) const {
    InitialRequest initial;
    initial.raft_fraction = request_.raft_fraction;
    initial.seed = request_.seed;
    const std::string wavelength = std::to_string(6 * request_.base.epsilon);
    StartState start = initial_state(problem_, "band-limited:wavelength=" + wavelength, initial);
    std::vector<Vec> result;
    Vec c = problem_.c_of(start.y);
    double t = 0;
    for (const double next : times) {
      c = advance(c, t, next);
      result.push_back(c);
      t = next;
    }
    return result;
  }
  Vec advance(ConstVec c, double begin, double end) const {
    return forecast(problem_, make_integrator_, c, begin, end).end;
  }

 private:
  const BlindRequest& request_;
  CahnHilliard problem_;
  MakeIntegrator make_integrator_;
};

// What the effect makes of the base's snapshots until the next one.
double one_step_gap(const SurfaceSpace& space, const Simulation& base, const Simulation& changed,
                    const std::vector<double>& times, const std::vector<Vec>& snapshots) {
  double squares = 0;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const Vec difference = changed.advance(snapshots[k], times[k], times[k + 1]) -
                           base.advance(snapshots[k], times[k], times[k + 1]);
    const double contrast = spread(space, snapshots[k]);
    squares += space.inner(difference, difference) / space.area / (contrast * contrast);
  }
  return std::sqrt(squares / static_cast<double>(times.size() - 1));
}

struct Sized {
  EffectTerm term;
  double gap;
};
// The strength at which the effect makes the gap that was asked for: a small one, then in
// proportion, twice.
Sized sized_effect(const BlindRequest& request, const SpacePtr& space,
                   const std::vector<double>& times) {
  const Simulation base(request, space, {});
  const std::vector<Vec> snapshots = base.run(times);
  const auto all = candidates();
  const auto candidate = std::find_if(
      all.begin(), all.end(), [&](const Candidate& c) { return c.effect == request.effect; });
  if (candidate == all.end())
    throw std::runtime_error("no effect '" + request.effect + "' can be hidden");
  std::vector<double> coefficients(candidate->directions, candidate->step);
  double gap = 0;
  for (int k = 0; k < 3; ++k) {
    if (k > 0)
      for (double& a : coefficients) a *= request.gap / gap;
    const Simulation changed(request, space, {candidate->term(coefficients)});
    gap = one_step_gap(*space, base, changed, times, snapshots);
  }
  return {candidate->term(coefficients), gap};
}

FieldSnapshot measure(const BlindRequest& request, const SurfaceSpace& space,
                      const Placement& placement, const Vec& c, int number, double time,
                      double noise) {
  FieldSnapshot snapshot{time, random_directions(request, number), {}, {}};
  std::vector<Point> places;
  for (const Point& x : snapshot.points) places.push_back(placement.in_mesh(x));
  snapshot.values = point_trace(space, places, space.h()) * c;
  snapshot.deviation = Vec::Ones(snapshot.values.size());
  for (Eigen::Index i = 0; i < snapshot.values.size(); ++i) {
    const auto u = [&](std::uint64_t j) {
      return uniform_random(request.seed, kNoise + static_cast<std::uint64_t>(number),
                            2 * static_cast<std::uint64_t>(i) + j);
    };
    snapshot.values[i] += noise * normal_pair(u(0), u(1))[0];
  }
  return snapshot;
}

}  // namespace

BlindCase draw_blind_case(const BlindRequest& request) {
  const double h = 2 * kBoxHalfWidth / request.cells;
  const Placement placement(request.seed, h);
  const auto space = std::make_shared<const SurfaceSpace>(
      ShiftedLevelSet(make_surface("sphere"), placement.offset), request.cells,
      std::make_shared<ThreadTeam>(request.threads), std::make_shared<SerialCommunicator>());
  const std::vector<double> labels = snapshot_times(request);
  std::vector<double> times;  // of the truth, whose unit is R²/(pace D)
  for (const double t : labels) times.push_back(request.pace * t);

  BlindCase result{{"1", {}}, {}, 0, 0};
  if (!request.effect.empty()) {
    const Sized sized = sized_effect(request, space, times);
    result.truth.push_back(sized.term);
    result.gap = sized.gap;
  }
  const std::vector<Vec> states = Simulation(request, space, result.truth).run(times);
  double contrast = 0;
  for (const Vec& c : states) contrast += spread(*space, c) / static_cast<double>(states.size());
  result.noise = request.noise * contrast;
  for (int k = 0; k < request.snapshots; ++k)
    result.series.snapshots.push_back(
        measure(request, *space, placement, states[k], k, labels[k], result.noise));
  return result;
}

}  // namespace traceraft
