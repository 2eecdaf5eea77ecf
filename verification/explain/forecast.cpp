#include "verification/explain/forecast.hpp"

#include <cmath>

#include "verification/bench.hpp"
#include "verification/explain/tangent_flow.hpp"

namespace traceraft {

TangentGrid TangentGrid::graded(double begin, double end, int steps) {
  TangentGrid grid;
  const auto time = [&](double i) {
    const double s = i / steps;
    return begin + (end - begin) * 0.5 * (s + s * s);
  };
  for (int i = 0; i < steps; ++i) {
    const double from = time(i), step = (i + 1 < steps ? time(i + 1) : end) - from;
    grid.steps.push_back(step);
    grid.stage_times.push_back(from + kTangentGamma * step);
    grid.stage_times.push_back(i + 1 < steps ? from + step : end);
  }
  return grid;
}

Forecast forecast(const CahnHilliard& problem, const MakeIntegrator& make_integrator, ConstVec c,
                  double begin, double end, int tangent_steps) {
  Vec y = Vec::Zero(problem.size()), ydot = Vec::Zero(problem.size());
  y.head(problem.block_size()) = c;
  require(problem.consistent_initial_state(begin, y, ydot));
  const IntegratorPtr integrator = make_integrator(problem);
  require(integrator->start(begin, y, ydot, end));
  Forecast result{TangentGrid::graded(begin, end, tangent_steps), {}, {}, {}};
  std::size_t next = 0;
  while (integrator->time() < end) {
    require(integrator->advance());
    for (; next < result.grid.stage_times.size() &&
           result.grid.stage_times[next] <= integrator->time();
         ++next) {
      require(integrator->interpolate(result.grid.stage_times[next], y));
      result.stages.push_back(y);
    }
  }
  y = integrator->state();
  require(problem.consistent_initial_state(end, y, ydot));
  result.end = problem.c_of(y);
  result.end_rate = problem.c_of(ydot);
  return result;
}

}  // namespace traceraft
