#include "backends/posix/process.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <thread>

namespace traceraft::posix {
namespace {

// Since then, and what it had taken: the system knows when a process began, but that may be hours
// ago where a shell, or a scheduler, has become this program (exec), and not when it became that.
// Loading libraries is work of a processor. What a shell has computed before counts as well: next
// to nothing as a rule.
const std::chrono::steady_clock::time_point kLoaded = std::chrono::steady_clock::now();
const double kLoading = cpu_seconds();

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

// Who starts a program by nohup wants it to go on without a terminal.
std::vector<int> signals_to_stop() {
  std::vector<int> signals = {SIGINT, SIGTERM, kParentDied};
  if (!is_ignored(SIGHUP)) signals.push_back(SIGHUP);
  return signals;
}

// Made before there are threads and children; a handler only reads it.
const std::vector<int> kStopSignals = signals_to_stop();

std::atomic<bool> stop_flag = false;
// When SIGINT or SIGTERM came first. A terminal, a manager of scopes and the parent may each send
// one: within that many seconds these are one request.
std::atomic<std::int64_t> asked_at = 0;
constexpr std::int64_t kOneRequest = 2;

// The exit code and the line of an end at once. Never freed: a signal may come at any time.
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
  if (signal == kParentDied || signal == SIGHUP) return;
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
    // A write to a pipe that nobody reads fails instead, and the failure is a hang-up.
    std::signal(SIGPIPE, SIG_IGN);
    const sigset_t set = stop_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::thread([set] {
      for (int signal = 0; sigwait(&set, &signal) == 0;) on_stop(signal);
    }).detach();
  });
}

}  // namespace

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - kLoaded).count() +
         kLoading;
}

namespace {

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double cpu_seconds() {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double thread_cpu_seconds() {
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
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
  std::signal(SIGPIPE, SIG_DFL);
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void hang_up() {
  // To the process, so that the thread which waits for signals takes it.
  (void)kill(getpid(), SIGHUP);
}

bool stop_requested() {
  return stop_flag;
}

void ignore_file_size_signal() {
  std::signal(SIGXFSZ, SIG_IGN);
}

void occupy_standard_descriptors() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    // Open for the wrong direction, so that using it still is an error. It is the lowest free one.
    const int opened = open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (opened != descriptor && opened >= 0) close(opened);
  }
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

}  // namespace traceraft::posix
