// Jobs that take long: processes of this program side by side, with a line that shows how far they
// are. What they leave in files lets the same command go on after an interruption.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "drivers/jobs/program_run.hpp"

namespace traceraft::jobs {

struct PendingJobs {
  std::size_t count = 0;   // that are left to do
  std::size_t before = 0;  // that were done before
  int at_a_time = 1;
  std::string kind;              // "runs": what the line counts
  std::filesystem::path folder;  // where all of them work
  bool quiet = false;

  std::function<ProcessEnd(std::size_t)> run;    // in threads of their own
  std::function<std::string(std::size_t)> name;  // for complaints: "the run of seed 3"
  // The share that is done of all jobs, those done before included. Empty: their number counts.
  std::function<double()> share = {};
  // After a job that succeeded, in its thread. May throw. Empty: nothing is to be done.
  std::function<void(std::size_t)> succeeded = {};
  // Empty: exit code 0.
  std::function<bool(const ProcessEnd&)> success = {};
};

struct JobFailure {
  std::size_t job;
  std::string why;
  bool locked = false;  // another process works on it
};

struct JobsEnd {
  bool stopped = false;              // a stop was asked for: there is more to do
  std::vector<JobFailure> failures;  // in the order of the jobs
};

// A job that fails leaves the others alone. Throws IoError for what no job is to blame for, such as
// a full disk.
JobsEnd run_pending_jobs(const PendingJobs& jobs);

// How many jobs at a time, and how many threads each.
struct Jobs {
  int at_a_time, threads;
};
// 0: as many as there are processors, and threads as those leave.
Jobs jobs_of(int at_a_time, int threads);

}  // namespace traceraft::jobs
