#include "backends/posix/process.hpp"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <thread>

namespace traceraft {
namespace {

constexpr int kStopSignals[] = {SIGINT, SIGTERM, kParentDied};

// When the process began, its libraries not yet loaded; now, where the system does not tell.
std::chrono::steady_clock::time_point start_of_process() {
  const auto now = std::chrono::steady_clock::now();
  std::ifstream file("/proc/self/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');  // names may hold anything
  if (name_end == std::string::npos) return now;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  constexpr int kBetween = 19;  // from the state, field 3, to the start, field 22 (proc(5))
  for (int i = 0; i < kBetween; ++i) fields >> skipped;
  long long ticks = 0;
  timespec since_boot{};
  if (!(fields >> ticks) || clock_gettime(CLOCK_BOOTTIME, &since_boot) != 0) return now;
  const double age = static_cast<double>(since_boot.tv_sec) +
                     1e-9 * static_cast<double>(since_boot.tv_nsec) -
                     static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return now - std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                   std::chrono::duration<double>(std::max(0.0, age)));
}

std::atomic<bool> stop_flag = false;
// When SIGINT or SIGTERM came first. A terminal, a manager of scopes and the parent may each send
// one: within that many seconds these are one request.
std::atomic<std::int64_t> asked_at = 0;
constexpr std::int64_t kOneRequest = 2;

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

void install(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : kStopSignals) sigaction(signal, &action, nullptr);
}

// May interrupt anything: calls nothing but what POSIX allows there.
void on_stop(int signal) {
  if (const End* end = end_at_once) {
    // Nothing can be done about an error here.
    [[maybe_unused]] const ssize_t written =
        write(STDERR_FILENO, end->line.data(), end->line.size());
    _exit(end->code);
  }
  install(on_stop);  // METIS puts back what there was as if by signal() of System V: for one signal
  stop_flag = true;
  if (signal == kParentDied) return;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  std::int64_t first = 0;
  const std::int64_t seconds = now.tv_sec + 1;  // not 0
  if (asked_at.compare_exchange_strong(first, seconds) || seconds - first < kOneRequest) return;
  default_stop_signals();
  std::raise(signal);
}

// A thread of its own waits for the signals, which this one and all that it starts block: METIS
// puts a handler of its own for SIGTERM, and one that jumps to where only its own thread has been.
void watch_stop_signals() {
  static std::once_flag once;
  std::call_once(once, [] {
    install(on_stop);  // for threads that are older than this
    const sigset_t set = stop_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::thread([set] {
      for (int signal = 0; sigwait(&set, &signal) == 0;) on_stop(signal);
    }).detach();
  });
}

}  // namespace

double wall_seconds() {
  static const auto process_start = start_of_process();
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
