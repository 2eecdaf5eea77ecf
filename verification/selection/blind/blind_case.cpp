#include "verification/selection/blind/blind_case.hpp"

#include <cmath>
#include <optional>

#include "kernel/core/random.hpp"
#include "verification/assimilation/fields/blur.hpp"
#include "verification/assimilation/fields/point_trace.hpp"
#include "verification/selection/blind/blind_looks.hpp"
#include "verification/selection/blind/blind_simulation.hpp"
#include "verification/selection/blind/effect_size.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::selection {
namespace {

// One vesicle on a mesh of its own.
class Vesicle {
 public:
  explicit Vesicle(const BlindRequest& request)
      : request_(request),
        looks_(request),
        space_(std::make_shared<const fem::SurfaceSpace>(
            looks_.surface, request.cells, std::make_shared<ThreadTeam>(request.threads),
            std::make_shared<SerialCommunicator>(), request.base.mass_stabilisation)) {}

  std::vector<Vec> states(const std::vector<effects::EffectTerm>& effects) const {
    const BlindMethod method{space_, request_.integrator, request_.tolerance};
    return BlindSimulation(request_, method, effects).run(looks_.times);
  }

  double contrast(const std::vector<Vec>& states) const {
    double sum = 0;
    for (const Vec& c : states) sum += spread(*space_, c);
    return sum / static_cast<double>(states.size());
  }

  void refuse_without_rafts(const std::vector<Vec>& states) const {
    for (const Vec& c : states) selection::refuse_without_rafts(spread(*space_, c));
  }

  std::vector<assimilation::FieldSnapshot> measure(const std::vector<Vec>& states,
                                                   double noise) const {
    std::optional<assimilation::Blur> blur;
    if (request_.blur > 0) blur.emplace(*space_, request_.blur);
    std::vector<assimilation::FieldSnapshot> snapshots;
    for (std::size_t k = 0; k < states.size(); ++k)
      snapshots.push_back(
          measure(blur ? blur->blurred(states[k]) : states[k], static_cast<int>(k), noise));
    return snapshots;
  }

 private:
  assimilation::FieldSnapshot measure(const Vec& c, int number, double noise) const {
    assimilation::FieldSnapshot snapshot{
        looks_.labels[number], BlindLooks::directions(request_, number), {}, {}};
    std::vector<Point> places;
    for (const Point& x : snapshot.points) places.push_back(looks_.placement.in_mesh(x));
    snapshot.values = assimilation::point_trace(*space_, places, space_->h()) * c;
    const double stated = number % 2 == 1 ? request_.stated : 1;
    snapshot.deviation =
        Vec::Constant(snapshot.values.size(), request_.stated > 0 ? stated * noise : 1);
    snapshot.values += noise * unit_noise(snapshot.points, static_cast<std::uint64_t>(number));
    return snapshot;
  }

  Vec unit_noise(const std::vector<Point>& points, std::uint64_t number) const {
    Vec result(static_cast<Eigen::Index>(points.size()));
    for (Eigen::Index i = 0; i < result.size(); ++i)
      result[i] = normal_random(request_.seed, statistics::stream::noise + number,
                                static_cast<std::uint64_t>(i));
    if (request_.noise_share <= 0) return result;
    return std::sqrt(1 - request_.noise_share) * result +
           std::sqrt(request_.noise_share) * noise_waves(points, request_.noise_correlation,
                                                         request_.noise_shape, request_.seed,
                                                         statistics::stream::shared_noise + number);
  }

  const BlindRequest& request_;
  const BlindLooks looks_;
  const bench::SpacePtr space_;
};

// Between the seeds of vesicles.
constexpr std::uint64_t kNextVesicle = 1000003;

}  // namespace

BlindCase draw_blind_case(const BlindRequest& request) {
  BlindCase result{{}, {}, 0};
  for (int v = 0; v < request.vesicles; ++v) {
    BlindRequest own = request;
    own.seed += kNextVesicle * static_cast<std::uint64_t>(v);
    if (v == 0) result.truth = size_effects(own);
    const Vesicle vesicle(own);
    const std::vector<Vec> states = vesicle.states(result.truth);
    if (result.truth.empty()) vesicle.refuse_without_rafts(states);
    if (v == 0) result.noise = request.noise * vesicle.contrast(states);
    result.vesicles.push_back({std::to_string(v + 1), vesicle.measure(states, result.noise)});
  }
  return result;
}

}  // namespace traceraft::selection
