#include "drivers/run/progress.hpp"

#include "kernel/core/text.hpp"

namespace traceraft::run {

void Progress::on_step(const simulation::RunState& state) {
  const time::Integrator& integrator = state.integrator;
  const double elapsed = watch_.seconds();
  left_.note(integrator.time(), elapsed);
  if (!line_.due() && integrator.time() < run_.t_end) return;
  const char* unit = run_.units.scaled ? "" : " s";
  const output::TimeLeft::Range left = left_.range();
  line_.show(left_.share(),
             formatted("t %.4g%s  step %ld  dt %.2g%s  mass drift %.0e  rafts %d  %s elapsed",
                       integrator.time() * run_.units.time(), unit, integrator.statistics().steps,
                       integrator.step() * run_.units.time(), unit, state.monitor.mass_drift(),
                       state.observables.rafts, output::clock_text(elapsed).c_str()) +
                 (left.high > 0 ? "  " + output::clock_text(left.low) + " to " +
                                      output::clock_text(left.high) + " left"
                                : ""));
}

}  // namespace traceraft::run
