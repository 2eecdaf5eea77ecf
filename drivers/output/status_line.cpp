#include "drivers/output/status_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "backends/posix/process.hpp"
#include "backends/ranks.hpp"
#include "drivers/text/say.hpp"

namespace traceraft::output {
namespace {

constexpr double kTerminalPause = 0.2;  // seconds between updates
constexpr double kPlainPause = 15;
constexpr int kBar = 24;  // columns

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

// mpirun gives ranks a terminal of its own, wherever its output goes.
StatusLine::StatusLine(bool quiet)
    : quiet_(quiet), terminal_(posix::stdout_is_terminal() && !backends::RankSession::there_is()) {}

bool StatusLine::due() const {
  return !quiet_ && (!shown_ || since_.seconds() >= (terminal_ ? kTerminalPause : kPlainPause));
}

void StatusLine::show(double share, const std::string& text) {
  if (quiet_) return;
  shown_ = true;
  since_ = Stopwatch();
  if (!terminal_) {
    text::say("%3.0f %%  %s\n", 100 * share, text);
  } else {
    const int columns = posix::terminal_columns() - 1;
    const int width = std::clamp(columns - static_cast<int>(text.size()) - 3, 0, kBar);
    std::string bar(static_cast<std::size_t>(width), '.');
    std::fill_n(bar.begin(), static_cast<std::size_t>(share * width), '#');
    text::say("\r\033[K%.*s", columns, ((width ? "[" + bar + "] " : "") + text));
  }
  text::flush_output();
}

void StatusLine::finish() {
  if (!quiet_ && terminal_ && shown_) text::say("\n");
  text::flush_output();
}

}  // namespace traceraft::output
