#include "drivers/run/progress.hpp"

#include "kernel/core/text.hpp"

namespace traceraft::run {

void Progress::on_step(const simulation::RunState& state) {
  const time::Integrator& integrator = state.integrator();
  show(integrator.time(), integrator.statistics().steps, integrator.step(),
       state.monitor.mass_drift(), state.observables.rafts);
}

void Progress::show(double t, std::int64_t steps, double step, double mass_drift, int rafts) {
  const double elapsed = watch_.seconds();
  left_.note(t, elapsed);
  if (!line_.due() && t < run_.t_end) return;
  const char* unit = run_.units.scaled ? "" : " s";
  const output::TimeLeft::Range left = left_.range();
  line_.show(left_.share(),
             formatted("t %.4g%s  step %lld  dt %.2g%s  mass drift %.0e  rafts %d  %s elapsed",
                       t * run_.units.time(), unit, static_cast<long long>(steps),
                       step * run_.units.time(), unit, mass_drift, rafts,
                       output::clock_text(elapsed).c_str()) +
                 (left.high > 0 ? "  " + output::clock_text(left.low) + " to " +
                                      output::clock_text(left.high) + " left"
                                : ""));
}

}  // namespace traceraft::run
