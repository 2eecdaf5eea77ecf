#include "drivers/run/progress.hpp"

#include "kernel/core/text.hpp"

namespace traceraft {

void Progress::on_step(const RunState& state) {
  const Integrator& integrator = state.integrator;
  const double elapsed = watch_.seconds();
  left_.note(integrator.time(), elapsed);
  if (!line_.due() && integrator.time() < run_.t_end) return;
  const char* unit = run_.units.scaled ? "" : " s";
  const TimeLeft::Range left = left_.range();
  line_.show(
      left_.share(),
      formatted("t %.4g%s  step %ld  dt %.2g%s  mass drift %.0e  rafts %d  %s elapsed",
                integrator.time() * run_.units.time(), unit, integrator.statistics().steps,
                integrator.step() * run_.units.time(), unit, state.monitor.mass_drift(),
                state.observables.rafts, clock_text(elapsed).c_str()) +
          (left.high > 0 ? "  " + clock_text(left.low) + " to " + clock_text(left.high) + " left"
                         : ""));
}

}  // namespace traceraft
