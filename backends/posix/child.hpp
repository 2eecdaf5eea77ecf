// Other programs, run to their end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace traceraft::posix {

struct ChildRequest {
  std::vector<std::string> command;   // program (looked up in PATH) and arguments
  std::filesystem::path log;          // what it prints, errors included, is added to it
  double time_limit = 0;              // seconds of wall time, then it is killed; 0: none
  std::filesystem::path folder = {};  // it works there; empty: where this process does
};

struct ChildResult {
  int exit_code = 0;  // 128 + signal if a signal ended it, 127 if there is no such program
  bool out_of_time = false;
};

// Runs a program in the environment that this process was started with, and waits. If this process
// is asked to stop (process.hpp) the child is, too, and its end is waited for; if this process
// dies, the child is asked to stop. Throws IoError if no process can be started.
ChildResult run_child(const ChildRequest& request);

// A path under which this very program can be run, even after its file has been replaced.
std::string own_program();
// The path of its file, for others that run it.
std::string own_path();

}  // namespace traceraft::posix
