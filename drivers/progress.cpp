#include "drivers/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "backends/posix/process.hpp"

namespace traceraft {
namespace {

constexpr double kTerminalPause = 0.2;  // seconds between updates
constexpr double kPlainPause = 15;

}  // namespace

std::string clock_text(double seconds) {
  char text[40];
  const long total = std::isfinite(seconds) ? static_cast<long>(std::min(seconds, 1e9)) : 0;
  if (total >= 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld", total / 60, total % 60);
  return text;
}

Progress::Progress(const RunSetup& run, bool quiet)
    : run_(run), quiet_(quiet), terminal_(stdout_is_terminal()) {}

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
  if (quiet_) return;
  const Integrator& integrator = state.integrator;
  if (first_step_ < 0) first_step_ = integrator.statistics().steps;
  if (printed_ && since_line_.seconds() < (terminal_ ? kTerminalPause : kPlainPause) &&
      integrator.time() < run_.t_end)
    return;
  printed_ = true;
  since_line_ = Stopwatch();

  const double left = estimated_seconds_left(state), elapsed = watch_.seconds();
  const bool started = integrator.statistics().steps > first_step_;
  const double share = integrator.time() >= run_.t_end ? 1
                       : started                       ? elapsed / (elapsed + left)
                                                       : 0;
  const char* unit = run_.units.scaled ? "" : " s";
  char line[256];
  std::snprintf(line, sizeof line,
                "t %.4g%s  step %ld  dt %.2g%s  mass drift %.0e  rafts %d  %s elapsed  ~%s left",
                integrator.time() * run_.units.time(), unit, integrator.statistics().steps,
                integrator.step() * run_.units.time(), unit, state.monitor.mass_drift(),
                state.row.rafts, clock_text(elapsed).c_str(), clock_text(left).c_str());
  if (!terminal_) {
    std::printf("%3.0f %%  %s\n", 100 * share, line);
  } else {
    const int columns = terminal_columns() - 1;
    const int width =
        std::clamp(columns - static_cast<int>(std::char_traits<char>::length(line)) - 3, 0, 24);
    std::string bar(static_cast<std::size_t>(width), '.');
    std::fill_n(bar.begin(), static_cast<std::size_t>(share * width), '#');
    std::printf("\r\033[K%.*s", columns, ((width ? "[" + bar + "] " : "") + line).c_str());
  }
  std::fflush(stdout);
}

void Progress::finish() {
  if (!quiet_ && terminal_ && printed_) std::printf("\n");
  std::fflush(stdout);
}

}  // namespace traceraft
