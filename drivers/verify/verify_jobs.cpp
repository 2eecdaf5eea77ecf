#include "drivers/verify/verify_jobs.hpp"

#include <unistd.h>

#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/job_pool.hpp"
#include "drivers/run/program_run.hpp"
#include "drivers/verify/verify_report.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

// In a folder of its own, which goes once its result is in that of the verification.
bool carry_out(const StudyJobs& jobs, const StudyEntry& study, const fs::path& folder) {
  const fs::path own = folder / ("job-" + study.name), log = own.string() + ".log";
  std::vector<std::string> arguments{"verify", study.name, "--quiet", "--out", own.string()};
  arguments.insert(arguments.end(), jobs.flags.begin(), jobs.flags.end());
  const ProgramEnd end = run_program(arguments, log);
  if (end.was_stopped()) return false;
  const auto result = end.exit_code == kSuccess || end.exit_code == kClaimFailed
                          ? measured_before(own, study, jobs.measured_with)
                          : std::nullopt;
  if (!result) throw IoError(study.name + ": " + end.reason() + ", see " + log.string());
  write_study(folder, *result, jobs.measured_with);
  remove_own_folder(own, files_of_a_verification());
  fs::remove(log);
  return true;
}

}  // namespace

bool carry_out_side_by_side(const StudyJobs& jobs, const fs::path& folder) {
  if (jobs.studies.empty()) return true;
  catch_stop_signals();
  JobPool pool(jobs.studies.size(),
               [&](std::size_t k) { return carry_out(jobs, jobs.studies[k], folder); });
  StatusLine line(jobs.quiet);
  const Stopwatch watch;
  pool.start(jobs.at_a_time);
  do {
    usleep(100000);
    if (line.due())
      line.show(static_cast<double>(pool.ended()) / static_cast<double>(jobs.studies.size()),
                std::to_string(pool.ended()) + "/" + std::to_string(jobs.studies.size()) +
                    " studies  " + clock_text(watch.seconds()) + " elapsed");
  } while (pool.busy());
  const bool all_done = pool.finish();
  line.finish();
  return all_done;
}

}  // namespace traceraft
