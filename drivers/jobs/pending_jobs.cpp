#include "drivers/jobs/pending_jobs.hpp"

#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <thread>

#include "drivers/exit_codes.hpp"
#include "drivers/jobs/job_pool.hpp"
#include "drivers/output/status_line.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::jobs {
namespace {

class Work {
 public:
  explicit Work(const PendingJobs& jobs) : jobs_(jobs) {}

  // Is there a reason to go on with others?
  bool execute(std::size_t job) {
    const ProcessEnd end = jobs_.run(job);
    if (jobs_.success ? jobs_.success(end) : end.exit_code == drivers::kSuccess) {
      if (jobs_.succeeded) jobs_.succeeded(job);
      return true;
    }
    if (end.was_stopped()) return false;
    const bool locked = end.exit_code == drivers::kLocked;
    if (!locked && !end.harms_no_other(jobs_.folder))
      throw IoError(jobs_.name(job) + ": " + end.reason());
    const std::lock_guard lock(mutex_);
    failures_.push_back({job, end.reason(), locked});
    return true;
  }

  std::vector<JobFailure> failures() {
    std::sort(failures_.begin(), failures_.end(),
              [](const JobFailure& a, const JobFailure& b) { return a.job < b.job; });
    return failures_;
  }

 private:
  const PendingJobs& jobs_;
  std::mutex mutex_;
  std::vector<JobFailure> failures_;
};

double share_done(const PendingJobs& jobs, std::size_t ended) {
  if (jobs.share) return jobs.share();
  return static_cast<double>(jobs.before + ended) / static_cast<double>(jobs.before + jobs.count);
}

// The time left is that of the work so far, as far as there is any to tell from.
void show(const PendingJobs& jobs, std::size_t ended, double share_before, const Stopwatch& watch,
          output::StatusLine& line) {
  constexpr double kTelling = 0.01;
  const double share = share_done(jobs, ended), worked = share - share_before;
  const double left = worked > kTelling ? watch.seconds() / worked * (1 - share) : 0;
  line.show(share, std::to_string(jobs.before + ended) + "/" +
                       std::to_string(jobs.before + jobs.count) + " " + jobs.kind + "  " +
                       output::clock_text(watch.seconds()) + " elapsed" +
                       (left > 0 ? "  ~" + output::clock_text(left) + " left" : ""));
}

}  // namespace

JobsEnd run_pending_jobs(const PendingJobs& jobs) {
  if (jobs.count == 0) return {};
  Work work(jobs);
  output::StatusLine line(jobs.quiet);
  const Stopwatch watch;
  const double share_before = share_done(jobs, 0);
  JobPool pool(jobs.count, [&](std::size_t job) { return work.execute(job); });
  pool.start(jobs.at_a_time);
  do {
    usleep(100000);
    if (line.due()) show(jobs, pool.ended(), share_before, watch, line);
  } while (pool.busy());
  const bool all = pool.finish();
  line.finish();
  return {!all, work.failures()};
}

Jobs jobs_of(int at_a_time, int threads) {
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (at_a_time == 0) at_a_time = processors;
  return {at_a_time, threads > 0 ? threads : std::max(1, processors / at_a_time)};
}

}  // namespace traceraft::jobs
