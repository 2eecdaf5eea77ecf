#include "backends/posix/child.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "backends/posix/process.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft {
namespace {

constexpr useconds_t kPause = 50000;  // microseconds between looks

pid_t spawn(const ChildRequest& request) {
  std::vector<char*> arguments;
  for (const std::string& word : request.command)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, request.log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = -1;
  const int error = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT) return -1;
  if (error != 0) throw IoError("cannot run " + request.command[0] + ": " + std::strerror(error));
  return child;
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
    if (request.tick) request.tick();
    usleep(kPause);
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

std::filesystem::path own_program() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

}  // namespace traceraft
