#include "verification/assimilation/forecast/forecast.hpp"

#include <cmath>
#include <stdexcept>

#include "verification/assimilation/forecast/tangent_flow.hpp"
#include "verification/bench/bench.hpp"

namespace traceraft::assimilation {

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

Forecast forecast(const problem::CahnHilliard& problem, const MakeIntegrator& make_integrator,
                  VecView c, double begin, double end, const std::vector<int>& tangent_steps,
                  int most_steps) {
  Vec y = Vec::Zero(problem.size()), ydot = Vec::Zero(problem.size());
  y.head(problem.block_size()) = c;
  bench::require(problem.consistent_initial_state(begin, y, ydot));
  const time::IntegratorPtr integrator = make_integrator(problem);
  bench::require(integrator->start(begin, y, ydot, end));
  Forecast result;
  for (const int steps : tangent_steps)
    result.paths.push_back({TangentGrid::graded(begin, end, steps), {}});
  for (int step = 0; integrator->time() < end; ++step) {
    if (step == most_steps) throw std::runtime_error("a forecast takes too many steps");
    bench::require(integrator->advance());
    for (TangentPath& path : result.paths) {
      const auto& times = path.grid.stage_times;
      while (path.stages.size() < times.size() && times[path.stages.size()] <= integrator->time()) {
        bench::require(integrator->interpolate(times[path.stages.size()], y));
        path.stages.push_back(y);
      }
    }
  }
  y = integrator->state();
  bench::require(problem.consistent_initial_state(end, y, ydot));
  result.end = problem.c_of(y);
  result.end_rate = problem.c_of(ydot);
  return result;
}

}  // namespace traceraft::assimilation
