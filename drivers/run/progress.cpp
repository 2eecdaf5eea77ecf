#include "drivers/run/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traceraft {

double Progress::estimated_seconds_left(const RunState& state) {
  // Steps grow in proportion to time while rafts coarsen, or stay as they are.
  const Integrator& integrator = state.integrator;
  const double t = integrator.time(), dt = std::max(integrator.next_step(), 1e-300);
  const double steady = (run_.t_end - t) / dt;
  const double growing = t > 0 ? t / dt * std::log(run_.t_end / t) : steady;
  const long done = integrator.statistics().steps - first_step_;
  return done > 0 ? std::min(steady, growing) * watch_.seconds() / static_cast<double>(done) : 0;
}

void Progress::on_step(const RunState& state) {
  const Integrator& integrator = state.integrator;
  const long steps = integrator.statistics().steps;
  if (first_step_ < 0) first_step_ = steps;
  if (!line_.due() && integrator.time() < run_.t_end) return;
  const double left = estimated_seconds_left(state), elapsed = watch_.seconds();
  const double share = integrator.time() >= run_.t_end ? 1
                       : steps > first_step_           ? elapsed / (elapsed + left)
                                                       : 0;
  const char* unit = run_.units.scaled ? "" : " s";
  char text[256];
  std::snprintf(text, sizeof text,
                "t %.4g%s  step %ld  dt %.2g%s  mass drift %.0e  rafts %d  %s elapsed  ~%s left",
                integrator.time() * run_.units.time(), unit, steps,
                integrator.step() * run_.units.time(), unit, state.monitor.mass_drift(),
                state.row.rafts, clock_text(elapsed).c_str(), clock_text(left).c_str());
  line_.show(share, text);
}

}  // namespace traceraft
