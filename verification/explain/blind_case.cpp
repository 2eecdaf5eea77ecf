#include "verification/explain/blind_case.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "backends/list.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/random.hpp"
#include "verification/explain/filter_problem.hpp"
#include "verification/explain/forecast.hpp"
#include "verification/explain/point_trace.hpp"

namespace traceraft {
namespace {

// Streams of random numbers: what is drawn for one purpose does not depend on how much is drawn for
// another.
enum Stream : std::uint64_t { kPlacement = 101, kTimes, kEffects, kPoints = 300, kNoise = 500 };

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
    points.push_back(uniform_direction(u(0), u(1)));
  }
  return points;
}

double spread(const SurfaceSpace& space, ConstVec c) {
  const double mean = space.integral(c) / space.area;
  return std::sqrt(std::max(0.0, space.inner(c, c) / space.area - mean * mean));
}

// Standard deviation of c below which there is nothing to see.
constexpr double kLeastContrast = 0.01;

// How a truth is advanced.
struct Method {
  SpacePtr space;
  std::string integrator;
  double tolerance;
};

class Simulation {
 public:
  Simulation(const BlindRequest& request, const Method& method,
             const std::vector<EffectTerm>& effects)
      : request_(request),
        problem_(method.space, with_effects(request.base, effects)),
        make_integrator_([method](const DaeProblem& problem) {
          IntegratorSettings settings;
          settings.tolerance = method.tolerance;
          return integrators()
              .find(method.integrator)
              .make(problem, choose_linear_solver("block", *method.space), method.space->team,
                    settings);
        }) {}

  // c at the times, which begin after 0.
  std::vector<Vec> run(const std::vector<double>& times) const {
    InitialRequest initial;
    initial.raft_fraction = request_.raft_fraction;
    initial.seed = request_.seed;
    const std::int64_t cells = problem_.space().mesh.cube.cells;
    initial.noise_cells =
        std::min(cells, request_.noise_cells > 0 ? request_.noise_cells : request_.cells / 4);
    const std::string smooth =
        "band-limited:wavelength=" + std::to_string(6 * request_.base.epsilon);
    StartState start =
        initial_state(problem_, request_.initial.empty() ? smooth : request_.initial, initial);
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

// Coefficients in a random direction that the effect allows.
std::vector<double> random_coefficients(const BlindRequest& request, const Candidate& candidate,
                                        std::uint64_t number) {
  std::vector<double> coefficients;
  for (int d = 0; d < candidate.directions; ++d) {
    const double u = uniform_random(request.seed, kEffects, 10 * number + d);
    const double sign = candidate.two_sided && u < 0.5 ? -1 : 1;
    coefficients.push_back(sign * candidate.step * (candidate.directions > 1 ? 0.2 + u : 1));
  }
  return coefficients;
}

// How strong effects have to be is found on a mesh that is coarser than the truth's: it need not be
// exact.
class Sizing {
 public:
  Sizing(const BlindRequest& request, const LevelSet& surface, const std::vector<double>& times)
      : request_(request), times_(times) {
    constexpr double kCoarser = 0.7, kTolerance = 1e-3;
    method_ = {serial_space(surface, static_cast<int>(kCoarser * request.cells)), "ida",
               kTolerance};
    const Simulation base(request, method_, {});
    snapshots_ = base.run(times);
    for (std::size_t k = 0; k + 1 < times.size(); ++k)
      next_.push_back(base.advance(snapshots_[k], times[k], times[k + 1]));
  }

  // The effect with the strength at which it makes the gap that was asked for, or the largest one
  // that it may have: a small one, then in proportion, twice.
  EffectTerm term(const std::string& effect, std::uint64_t number) const {
    const Candidate candidate = candidate_of(effect);
    std::vector<double> coefficients = random_coefficients(request_, candidate, number);
    for (int k = 0; k < 2; ++k) {
      const double ratio = request_.gap / gap_of(candidate.term(coefficients));
      for (double& a : coefficients) a = candidate.within_range(ratio * a);
    }
    return candidate.term(coefficients);
  }

 private:
  static Candidate candidate_of(const std::string& effect) {
    const auto valid = effects_to_hide(), known = effects().names();
    if (std::find(valid.begin(), valid.end(), effect) == valid.end())
      throw InputError(std::find(known.begin(), known.end(), effect) != known.end()
                           ? "the effect " + effect + " is none that explain looks for on a sphere"
                           : unknown_name_message("effect to hide", effect, valid));
    return *find_candidate(effect);
  }
  // What the effect makes of the base's snapshots until the next one.
  double gap_of(const EffectTerm& term) const {
    const Simulation changed(request_, method_, {term});
    const SurfaceSpace& space = *method_.space;
    double squares = 0;
    for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
      const Vec difference = changed.advance(snapshots_[k], times_[k], times_[k + 1]) - next_[k];
      const double contrast = spread(space, snapshots_[k]);
      if (!(contrast > kLeastContrast))
        throw InputError(
            "the base model has no rafts at these times: c is the same everywhere; take "
            "a larger raft fraction (smooth noise of less than 0.21 dissolves), or other times");
      squares += space.inner(difference, difference) / space.area / (contrast * contrast);
    }
    return std::sqrt(squares / static_cast<double>(times_.size() - 1));
  }

  const BlindRequest& request_;
  const std::vector<double>& times_;
  Method method_;
  std::vector<Vec> snapshots_, next_;  // of the base; what becomes of each until the next time
};

// Where and when a vesicle is looked at.
struct Looks {
  Placement placement;
  ShiftedLevelSet surface;
  std::vector<double> labels, times;  // times: of the truth, whose unit is R²/(pace D)

  explicit Looks(const BlindRequest& request)
      : placement(request.seed, 2 * kBoxHalfWidth / request.cells),
        surface(make_surface("sphere"), placement.offset),
        labels(snapshot_times(request)) {
    for (const double t : labels) times.push_back(request.pace * t);
  }
};

// One vesicle on a mesh of its own.
class Vesicle {
 public:
  explicit Vesicle(const BlindRequest& request)
      : request_(request),
        looks_(request),
        space_(std::make_shared<const SurfaceSpace>(looks_.surface, request.cells,
                                                    std::make_shared<ThreadTeam>(request.threads),
                                                    std::make_shared<SerialCommunicator>())) {}

  std::vector<Vec> states(const std::vector<EffectTerm>& effects) const {
    const Method method{space_, request_.integrator, request_.tolerance};
    return Simulation(request_, method, effects).run(looks_.times);
  }

  double contrast(const std::vector<Vec>& states) const {
    double sum = 0;
    for (const Vec& c : states) sum += spread(*space_, c);
    return sum / static_cast<double>(states.size());
  }

  std::vector<FieldSnapshot> measure(const std::vector<Vec>& states, double noise) const {
    std::vector<FieldSnapshot> snapshots;
    for (std::size_t k = 0; k < states.size(); ++k)
      snapshots.push_back(measure(states[k], static_cast<int>(k), noise));
    return snapshots;
  }

 private:
  FieldSnapshot measure(const Vec& c, int number, double noise) const {
    FieldSnapshot snapshot{looks_.labels[number], random_directions(request_, number), {}, {}};
    std::vector<Point> places;
    for (const Point& x : snapshot.points) places.push_back(looks_.placement.in_mesh(x));
    snapshot.values = point_trace(*space_, places, space_->h()) * c;
    const double stated = number % 2 == 1 ? request_.stated : 1;
    snapshot.deviation =
        Vec::Constant(snapshot.values.size(), request_.stated > 0 ? stated * noise : 1);
    for (Eigen::Index i = 0; i < snapshot.values.size(); ++i)
      snapshot.values[i] +=
          noise * normal_random(request_.seed, kNoise + static_cast<std::uint64_t>(number),
                                static_cast<std::uint64_t>(i));
    return snapshot;
  }

  const BlindRequest& request_;
  const Looks looks_;
  const SpacePtr space_;
};

// Between the seeds of vesicles.
constexpr std::uint64_t kNextVesicle = 1000003;

}  // namespace

std::vector<std::string> effects_to_hide() {
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates())
    if (candidate.effect != "curvature") names.push_back(candidate.effect);
  return names;
}

std::vector<EffectTerm> size_effects(const BlindRequest& request) {
  std::vector<EffectTerm> terms;
  if (request.effects.empty()) return terms;
  const Looks looks(request);
  const Sizing sizing(request, looks.surface, looks.times);
  for (std::size_t k = 0; k < request.effects.size(); ++k)
    terms.push_back(sizing.term(request.effects[k], k));
  return terms;
}

BlindCase draw_blind_case(const BlindRequest& request) {
  BlindCase result{{}, {}, 0};
  for (int v = 0; v < request.vesicles; ++v) {
    BlindRequest own = request;
    own.seed += kNextVesicle * static_cast<std::uint64_t>(v);
    if (v == 0) result.truth = size_effects(own);
    const Vesicle vesicle(own);
    const std::vector<Vec> states = vesicle.states(result.truth);
    if (v == 0) result.noise = request.noise * vesicle.contrast(states);
    result.vesicles.push_back({std::to_string(v + 1), vesicle.measure(states, result.noise)});
  }
  return result;
}

}  // namespace traceraft
