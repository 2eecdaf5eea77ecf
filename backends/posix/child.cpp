#include "backends/posix/child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "backends/posix/process.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft::posix {
namespace {

constexpr useconds_t kPause = 50000;  // microseconds between looks

// In the new process, with nothing but calls that are safe after a fork: becomes the program, or
// reports why not.
[[noreturn]] void become(char* const* arguments, char* const* environment,
                         const ChildRequest& request, pid_t parent, int report) {
  prctl(PR_SET_PDEATHSIG, kParentDied);
  if (getppid() != parent) _exit(1);  // it died before that
  default_stop_signals();
  setpgid(0, 0);  // Ctrl-C reaches the parent, which asks once; twice would be "at once"
  const int input = open("/dev/null", O_RDONLY);
  // Another process may be writing to it, as of a run that both want to go on with.
  const int output = open(request.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW, 0644);
  const bool there = request.folder.empty() || chdir(request.folder.c_str()) == 0;
  if (input >= 0 && output >= 0 && there && dup2(input, STDIN_FILENO) >= 0 &&
      dup2(output, STDOUT_FILENO) >= 0 && dup2(output, STDERR_FILENO) >= 0)
    execvpe(arguments[0], arguments, environment);
  const int error = errno;
  const auto told = write(report, &error, sizeof error);
  _exit(told == sizeof error ? 127 : 126);
}

// The environment that this process was started with, "name=value" each. MPI, once initialised, has
// set variables that make an mpirun among the children fail.
std::vector<std::string> first_environment() {
  std::ifstream file("/proc/self/environ");
  if (!file) throw IoError("cannot read /proc/self/environ");
  std::vector<std::string> variables;
  bool has_path = false;
  for (std::string variable; std::getline(file, variable, '\0');) {
    has_path = has_path || variable.compare(0, 5, "PATH=") == 0;
    variables.push_back(variable);
  }
  // This process finds programs without one. Those that look for others, such as mpirun, may not.
  if (!has_path) variables.emplace_back("PATH=/usr/local/bin:/usr/bin:/bin");
  return variables;
}

std::vector<char*> for_exec(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

// −1: there is no such program.
pid_t spawn(const ChildRequest& request) {
  const std::vector<std::string> variables = first_environment();
  const std::vector<char*> arguments = for_exec(request.command), environment = for_exec(variables);
  int report[2];
  if (pipe2(report, O_CLOEXEC) != 0) throw IoError(std::string("pipe: ") + std::strerror(errno));
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become(arguments.data(), environment.data(), request, parent, report[1]);
  const int fork_error = errno;
  close(report[1]);
  int error = 0;
  if (child >= 0 && read(report[0], &error, sizeof error) == sizeof error)
    waitpid(child, nullptr, 0);
  close(report[0]);
  if (child < 0) error = fork_error;
  if (error == 0) return child;
  if (error == ENOENT && !std::filesystem::exists(request.log)) error = EIO;  // the log, then
  if (error == ENOENT) return -1;
  throw IoError("cannot run " + request.command[0] + " with output to " + request.log.string() +
                ": " + std::strerror(error));
}

}  // namespace

ChildResult run_child(const ChildRequest& request) {
  const Stopwatch watch;
  const pid_t child = spawn(request);
  ChildResult result;
  if (child < 0) return {127, false};
  bool told = false;
  int status = 0;
  while (true) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) break;
    if (ended < 0 && errno != EINTR)
      throw IoError(std::string("waiting for a process: ") + std::strerror(errno));
    if (stop_requested() && !told) {
      kill(child, SIGTERM);
      told = true;
    }
    if (request.time_limit > 0 && watch.seconds() > request.time_limit && !result.out_of_time) {
      kill(child, SIGKILL);
      result.out_of_time = true;
    }
    usleep(kPause);
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

std::string own_path() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

std::string own_program() {
  return "/proc/self/exe";
}

}  // namespace traceraft::posix
