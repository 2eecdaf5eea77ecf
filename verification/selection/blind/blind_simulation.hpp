// The simulation that stands for a vesicle in synthetic measurements.
#pragma once

#include "kernel/effects/effects.hpp"
#include "verification/assimilation/forecast/forecast.hpp"
#include "verification/bench/bench.hpp"
#include "verification/selection/blind/blind_request.hpp"

namespace traceraft::selection {

// How a truth is advanced.
struct BlindMethod {
  bench::SpacePtr space;
  std::string integrator;
  double tolerance;
};

class BlindSimulation {
 public:
  // The request must outlive it. Throws std::runtime_error where it cannot be advanced.
  BlindSimulation(const BlindRequest& request, const BlindMethod& method,
                  const std::vector<effects::EffectTerm>& effects);

  // c at the times, which begin after 0.
  std::vector<Vec> run(const std::vector<double>& times) const;
  Vec advance(VecView c, double begin, double end) const;

 private:
  const BlindRequest& request_;
  problem::CahnHilliard problem_;
  assimilation::MakeIntegrator make_integrator_;
};

// Standard deviation of c over the surface.
double spread(const fem::SurfaceSpace& space, VecView c);

}  // namespace traceraft::selection
