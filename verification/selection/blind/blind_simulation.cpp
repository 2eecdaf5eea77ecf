#include "verification/selection/blind/blind_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "backends/list.hpp"

namespace traceraft::selection {

namespace {

// Vesicles have random effects of their own.
problem::CahnHilliardModel with_seed(const BlindRequest& request) {
  problem::CahnHilliardModel model = request.base;
  model.seed = request.seed;
  return model;
}

}  // namespace

BlindSimulation::BlindSimulation(const BlindRequest& request, const BlindMethod& method,
                                 const std::vector<effects::EffectTerm>& effects)
    : request_(request),
      problem_(method.space, effects::with_effects(with_seed(request), effects)),
      make_integrator_([method](const problem::DaeProblem& problem) {
        time::IntegratorSettings settings;
        settings.tolerance = method.tolerance;
        return backends::integrators()
            .find(method.integrator)
            .make(problem, backends::choose_linear_solver("block", *method.space),
                  method.space->team, settings);
      }) {}

std::vector<Vec> BlindSimulation::run(const std::vector<double>& times) const {
  problem::InitialRequest initial;
  initial.raft_fraction = request_.raft_fraction;
  initial.seed = request_.seed;
  const std::int64_t cells = problem_.space().mesh.cube.cells;
  initial.noise_cells =
      std::min(cells, request_.noise_cells > 0 ? request_.noise_cells : request_.cells / 4);
  const std::string smooth = "band-limited:wavelength=" + std::to_string(6 * request_.base.epsilon);
  bench::StartState start =
      bench::initial_state(problem_, request_.initial.empty() ? smooth : request_.initial, initial);
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

Vec BlindSimulation::advance(VecView c, double begin, double end) const {
  constexpr int kMostSteps = 100000;  // from noise to a few rafts takes thousands
  return assimilation::forecast(problem_, make_integrator_, c, begin, end, {}, kMostSteps).end;
}

double spread(const fem::SurfaceSpace& space, VecView c) {
  const double mean = space.integral(c) / space.area;
  return std::sqrt(std::max(0.0, space.inner(c, c) / space.area - mean * mean));
}

}  // namespace traceraft::selection
