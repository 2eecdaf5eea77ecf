// Runs of this program as processes of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "verification/bench/bench.hpp"

namespace traceraft::jobs {

struct ProcessEnd {
  int exit_code = 0;
  bool out_of_time = false;
  std::string last_line;  // of what it printed

  int signal() const;          // that ended it, or 0
  std::string reason() const;  // of a failure, in a line
  bool was_stopped() const;    // it, or this process, was asked to
  // Does its end say something of what it was given to do? Bad input (a solver that refuses the
  // mesh), numerical failure, too little memory and crashes do; a full disk, a folder in use or
  // somebody who stopped it do not.
  bool concerns_input() const;
  // Is it of no concern to others whose folders are on the same disk? So are telling ends, and
  // damaged files unless the disk of `folder` is full.
  bool harms_no_other(const std::filesystem::path& folder) const;
};

// Runs this program to its end, under mpirun if on more than one rank. What it prints goes to
// `log`. `time_limit` as of ChildRequest. Throws IoError if no process can be started.
ProcessEnd run_program(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                       int ranks = 1, double time_limit = 0);

// Studies' runs of the program. Each works in the folder `scratch` and removes it at its end.
bench::RunProgram program_runner(std::filesystem::path scratch);

}  // namespace traceraft::jobs
