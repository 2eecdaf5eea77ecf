#include "kernel/effects/brownian_flow.hpp"

#include <array>
#include <cmath>
#include <mutex>

#include "kernel/core/random.hpp"

namespace traceraft::effects {
namespace {

// Draws of this effect stand far from those of others with the same seed.
constexpr std::uint64_t kFirstStream = std::uint64_t{1} << 40;

}  // namespace

// The draws before and after the time that was asked for last are kept, with their ghosts.
class BrownianFlow::Streams {
 public:
  Streams(const BrownianFlow& flow, const fem::SurfaceSpace& space)
      : flow_(&flow), space_(make_flow_space(space, flow.membrane_, flow.degree_)) {}

  const std::vector<flow::ElementCurl>& curls() const { return space_.curls; }
  Vec draw(double number) const {
    const auto stream = kFirstStream + static_cast<std::uint64_t>(number);
    Vec normal(space_.harmonics.size());
    for (Eigen::Index k = 0; k < normal.size(); ++k)
      normal[k] = normal_random(flow_->seed_, stream, static_cast<std::uint64_t>(k));
    return std::sqrt(2 * flow_->membrane_.thermal / flow_->hold_) *
           space_.friction->brownian(normal);
  }
  // ψ at the nodes and ghosts for each independent normal number, but the constant.
  const Eigen::MatrixXd& modes(const fem::SurfaceSpace& space) const {
    const std::lock_guard lock(mutex_);
    if (modes_.size() > 0) return modes_;
    const Eigen::Index size = space_.harmonics.size();
    Vec buffer;
    for (Eigen::Index k = 1; k < size; ++k) {
      const Vec psi = space.with_ghosts(
          space_.harmonics.synthesis(space_.friction->brownian(Vec::Unit(size, k))), buffer);
      if (k == 1) modes_.resize(psi.size(), size - 1);
      modes_.col(k - 1) = std::sqrt(2 * flow_->membrane_.thermal) * psi;
    }
    return modes_;
  }
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
      known.psi = space.with_ghosts(space_.harmonics.synthesis(draw(number)), buffer);
      known.number = number;
    }
    return known.psi;
  }

  const BrownianFlow* flow_;
  FlowSpace space_;
  mutable std::mutex mutex_;
  mutable std::array<Known, 2> known_;
  mutable Eigen::MatrixXd modes_;
};

BrownianFlow::BrownianFlow(const flow::FluidMembrane& membrane, double epsilon, double hold,
                           std::uint64_t seed)
    : membrane_(membrane),
      degree_(flow::brownian_degree(epsilon)),
      hold_(hold),
      seed_(seed),
      streams_([this](const fem::SurfaceSpace& space) {
        return std::make_shared<const Streams>(*this, space);
      }) {}

BrownianFlow::~BrownianFlow() = default;

Vec BrownianFlow::draw(const fem::SurfaceSpace& space, double number) const {
  return streams_.on(space)->draw(number);
}

Eigen::MatrixXd BrownianFlow::noises(const fem::SurfaceSpace& space, VecView c) const {
  const auto streams = streams_.on(space);
  const Eigen::MatrixXd& modes = streams->modes(space);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(space.nodes(), modes.cols());
  for (Eigen::Index k = 0; k < modes.cols(); ++k)
    flow::add_transport(space, streams->curls(), 1, c, modes.col(k), result.col(k));
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
