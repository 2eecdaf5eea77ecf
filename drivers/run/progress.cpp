#include "drivers/run/progress.hpp"

#include <cstdio>

namespace traceraft {

void Progress::on_step(const RunState& state) {
  const Integrator& integrator = state.integrator;
  const double elapsed = watch_.seconds();
  left_.note(integrator.time(), elapsed);
  if (!line_.due() && integrator.time() < run_.t_end) return;
  const char* unit = run_.units.scaled ? "" : " s";
  char text[256];
  std::snprintf(text, sizeof text,
                "t %.4g%s  step %ld  dt %.2g%s  mass drift %.0e  rafts %d  %s elapsed  ~%s left",
                integrator.time() * run_.units.time(), unit, integrator.statistics().steps,
                integrator.step() * run_.units.time(), unit, state.monitor.mass_drift(),
                state.row.rafts, clock_text(elapsed).c_str(), clock_text(left_.seconds()).c_str());
  line_.show(left_.share(), text);
}

}  // namespace traceraft
