#include "backends/posix/process.hpp"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>

namespace traceraft {
namespace {

volatile std::sig_atomic_t stop_flag = 0;
const auto process_start = std::chrono::steady_clock::now();

int code_at_end = 0;
std::string line_at_end;

void on_end(int) {
  // Nothing can be done about an error here.
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, line_at_end.data(), line_at_end.size());
  _exit(code_at_end);
}

void on_stop(int signal) {
  if (stop_flag) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  stop_flag = 1;
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
  struct sigaction action {};
  action.sa_handler = on_stop;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = [](int) { stop_flag = 1; };
  sigaction(kParentDied, &action, nullptr);
}

void end_on_stop_signals(int exit_code, const std::string& line) {
  code_at_end = exit_code;
  line_at_end = line + "\n";
  struct sigaction action {};
  action.sa_handler = on_end;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, kParentDied}) sigaction(signal, &action, nullptr);
}

bool stop_requested() {
  return stop_flag != 0;
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
