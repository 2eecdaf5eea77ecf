#include "kernel/effects/brownian_flow.hpp"

#include <array>
#include <cmath>
#include <mutex>

#include "kernel/core/random.hpp"

namespace traceraft::effects {
namespace {

// Draws of this effect stand far from those of others with the same seed.
constexpr std::uint64_t kFirstStream = std::uint64_t{1} << 40;

Vec deviation_of(const flow::FluidMembrane& membrane, int degree, double hold) {
  return flow::by_degree(degree, [&](int l) {
    return l < 1 ? 0 : std::sqrt(2 * membrane.thermal / (membrane.friction(l) * hold));
  });
}

}  // namespace

// The draws before and after the time that was asked for last are kept, with their ghosts.
class BrownianFlow::Streams {
 public:
  Streams(const BrownianFlow& flow, const fem::SurfaceSpace& space)
      : flow_(&flow), space_(flow_space(flow.degree_)(space)) {}

  const std::vector<flow::ElementCurl>& curls() const { return space_->curls; }
  Vec at(const fem::SurfaceSpace& space, double t) const {
    const double when = t / flow_->hold_, number = std::floor(when), share = when - number;
    const std::lock_guard lock(mutex_);
    return (1 - share) * at_hold(space, number) + share * at_hold(space, number + 1);
  }

 private:
  struct Known {
    double number = -1;
    Vec psi;
  };

  // Neighbours stand in different places.
  const Vec& at_hold(const fem::SurfaceSpace& space, double number) const {
    Known& known = known_[std::fmod(number, 2) == 0 ? 0 : 1];
    if (known.number != number || known.psi.size() == 0) {
      Vec buffer;
      known.psi = space.with_ghosts(space_->harmonics.synthesis(flow_->draw(number)), buffer);
      known.number = number;
    }
    return known.psi;
  }

  const BrownianFlow* flow_;
  std::shared_ptr<const FlowSpace> space_;
  mutable std::mutex mutex_;
  mutable std::array<Known, 2> known_;
};

BrownianFlow::BrownianFlow(const flow::FluidMembrane& membrane, double epsilon, double hold,
                           std::uint64_t seed)
    : degree_(flow::brownian_degree(epsilon)),
      deviation_(deviation_of(membrane, degree_, hold)),
      hold_(hold),
      seed_(seed),
      streams_([this](const fem::SurfaceSpace& space) {
        return std::make_shared<const Streams>(*this, space);
      }) {}

BrownianFlow::~BrownianFlow() = default;

Vec BrownianFlow::draw(double number) const {
  Vec result(deviation_.size());
  const auto stream = kFirstStream + static_cast<std::uint64_t>(number);
  for (Eigen::Index k = 0; k < result.size(); ++k)
    result[k] = deviation_[k] * normal_random(seed_, stream, static_cast<std::uint64_t>(k));
  return result;
}

void BrownianFlow::add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView,
                                VecRef residual_c, VecRef) const {
  const auto streams = streams_.on(space);
  flow::add_transport(space, streams->curls(), -1, c, streams->at(space, t), residual_c);
}

void BrownianFlow::add_tangent(const fem::SurfaceSpace& space, double t, VecView, VecView,
                               linear::BlockJacobian& J) const {
  const auto streams = streams_.on(space);
  flow::add_transport_matrix(space, streams->curls(), -1, streams->at(space, t), J.cc);
}

void BrownianFlow::add_tangent_product(const fem::SurfaceSpace& space, double t, VecView, VecView,
                                       VecView direction_c, VecView, VecRef product_c,
                                       VecRef) const {
  const auto streams = streams_.on(space);
  flow::add_transport(space, streams->curls(), -1, direction_c, streams->at(space, t), product_c);
}

}  // namespace traceraft::effects
