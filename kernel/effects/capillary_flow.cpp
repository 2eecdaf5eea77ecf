#include "kernel/effects/capillary_flow.hpp"

namespace traceraft::effects {

CapillaryFlow::CapillaryFlow(const flow::FluidMembrane& membrane, double epsilon)
    : capillary_(membrane.capillary),
      operators_([membrane, epsilon](const fem::SurfaceSpace& space) {
        return std::make_shared<const FlowSpace>(
            make_flow_space(space, membrane, flow::capillary_degree(epsilon)));
      }) {}

Vec CapillaryFlow::stream(const fem::SurfaceSpace& space, VecView c, VecView mu) const {
  const auto operators = operators_.on(space);
  Vec force = Vec::Zero(space.nodes());
  flow::add_transport(space, operators->curls, capillary_, c, mu, force);
  return operators->friction->capillary(operators->harmonics.analysis(force));
}

double CapillaryFlow::dissipation(const fem::SurfaceSpace& space, VecView c, VecView mu) const {
  return operators_.on(space)->friction->power(stream(space, c, mu)) / capillary_;
}

Vec CapillaryFlow::stream_at_nodes(const fem::SurfaceSpace& space, VecView c, VecView mu) const {
  return operators_.on(space)->harmonics.synthesis(stream(space, c, mu));
}

// Flow is linear in μ.
void CapillaryFlow::add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                                 VecRef residual_c, VecRef) const {
  add_stabilised_product(space, t, c, mu, residual_c);
}

void CapillaryFlow::add_stabilised_product(const fem::SurfaceSpace& space, double, VecView c,
                                           VecView direction_mu, VecRef product_c) const {
  Vec buffer;
  const Vec psi = stream_at_nodes(space, c, direction_mu);
  flow::add_transport(space, operators_.on(space)->curls, -1, c, space.with_ghosts(psi, buffer),
                      product_c);
}

void CapillaryFlow::add_tangent(const fem::SurfaceSpace& space, double, VecView c, VecView mu,
                                linear::BlockJacobian& J) const {
  Vec buffer;
  const Vec psi = stream_at_nodes(space, c, mu);
  flow::add_transport_matrix(space, operators_.on(space)->curls, -1, space.with_ghosts(psi, buffer),
                             J.cc);
}

void CapillaryFlow::add_tangent_product(const fem::SurfaceSpace& space, double, VecView c,
                                        VecView mu, VecView direction_c, VecView direction_mu,
                                        VecRef product_c, VecRef) const {
  const auto operators = operators_.on(space);
  const auto& curls = operators->curls;
  Vec buffer, force = Vec::Zero(space.nodes());
  const Vec psi = stream_at_nodes(space, c, mu);
  flow::add_transport(space, curls, -1, direction_c, space.with_ghosts(psi, buffer), product_c);
  flow::add_transport(space, curls, capillary_, direction_c, mu, force);
  flow::add_transport(space, curls, capillary_, c, direction_mu, force);
  const flow::HarmonicTransform& harmonics = operators->harmonics;
  const Vec change = harmonics.synthesis(operators->friction->capillary(harmonics.analysis(force)));
  flow::add_transport(space, curls, -1, c, space.with_ghosts(change, buffer), product_c);
}

}  // namespace traceraft::effects
