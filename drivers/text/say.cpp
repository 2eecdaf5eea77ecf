#include "drivers/text/say.hpp"

#include <cerrno>
#include <cstring>
#include <mutex>

#include "backends/posix/process.hpp"

namespace traceraft::text {
namespace {

std::mutex mutex;
int first_error = 0;

void note_error(bool failed) {
  if (!failed) return;
  const std::lock_guard lock(mutex);
  if (first_error != 0) return;
  first_error = errno != 0 ? errno : EIO;
  if (first_error == EPIPE) posix::hang_up();
}

}  // namespace

void say_encoded(const std::string& text) {
  errno = 0;
  note_error(std::fwrite(text.data(), 1, text.size(), stdout) != text.size());
}

void flush_output() {
  errno = 0;
  note_error(std::fflush(stdout) != 0);
}

std::string output_error() {
  flush_output();
  const std::lock_guard lock(mutex);
  return first_error == 0 ? "" : std::strerror(first_error);
}

void say_error(const std::string& message) {
  // There is nobody to tell that nobody can be told.
  const std::string line = in_one_line("traceraft: " + message, kLongestMessage) + "\n";
  (void)std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace traceraft::text
