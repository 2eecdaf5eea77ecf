#include "backends/posix/process.hpp"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <thread>

namespace traceraft {
namespace {

constexpr int kStopSignals[] = {SIGINT, SIGTERM, kParentDied};

std::atomic<bool> stop_flag = false;
const auto process_start = std::chrono::steady_clock::now();

// What ends the process at once. Never freed: a signal may come at any time.
struct End {
  int code;
  std::string line;
};
std::atomic<const End*> end_at_once = nullptr;

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : kStopSignals) sigaddset(&set, signal);
  return set;
}

// May interrupt anything: calls nothing but what POSIX allows there.
void on_stop(int signal) {
  if (const End* end = end_at_once) {
    // Nothing can be done about an error here.
    [[maybe_unused]] const ssize_t written =
        write(STDERR_FILENO, end->line.data(), end->line.size());
    _exit(end->code);
  }
  const bool second = stop_flag.exchange(true);
  if (!second || signal == kParentDied) return;
  default_stop_signals();
  std::raise(signal);
}

// A thread of its own waits for the signals, which this one and all that it starts block: METIS
// puts a handler of its own for SIGTERM, and one that jumps to where only its own thread has been.
void watch_stop_signals() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action {};  // for threads that are older than this
    action.sa_handler = on_stop;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int signal : kStopSignals) sigaction(signal, &action, nullptr);
    const sigset_t set = stop_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::thread([set] {
      for (int signal = 0; sigwait(&set, &signal) == 0;) on_stop(signal);
    }).detach();
  });
}

}  // namespace

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - process_start).count();
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

bool is_superuser() {
  return geteuid() == 0;
}

bool stdout_is_terminal() {
  return isatty(STDOUT_FILENO) == 1;
}

int terminal_columns() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void catch_stop_signals() {
  end_at_once = nullptr;
  watch_stop_signals();
}

void end_on_stop_signals(int exit_code, const std::string& line) {
  end_at_once = new End{exit_code, line.empty() ? "" : line + "\n"};
  watch_stop_signals();
}

void default_stop_signals() {
  for (const int signal : kStopSignals) std::signal(signal, SIG_DFL);
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

bool stop_requested() {
  return stop_flag;
}

void ignore_file_size_signal() {
  std::signal(SIGXFSZ, SIG_IGN);
}

void restart_with_environment(const std::vector<std::pair<std::string, std::string>>& variables,
                              char** argv) {
  bool changed = false;
  for (const auto& [name, value] : variables)
    if (!std::getenv(name.c_str()))
      changed = setenv(name.c_str(), value.c_str(), 1) == 0 || changed;
  if (!changed) return;
  // By its own path, so that the process keeps its name.
  std::error_code no_proc;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", no_proc);
  if (!no_proc) execv(program.c_str(), argv);
}

}  // namespace traceraft
