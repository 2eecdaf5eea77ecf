#include "drivers/verify/verify_jobs.hpp"

#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/jobs/pending_jobs.hpp"
#include "drivers/verify/verify_report.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::verify {
namespace {

namespace fs = std::filesystem;

fs::path own_folder(const fs::path& folder, const studies::StudyEntry& study) {
  return folder / ("job-" + study.name);
}
fs::path log_of(const fs::path& folder, const studies::StudyEntry& study) {
  return own_folder(folder, study).string() + ".log";
}

// Takes the result of a study into the folder of the verification and removes the study's own.
void take_over(const StudyJobs& jobs, const studies::StudyEntry& study, const fs::path& folder) {
  const auto result = measured_before(own_folder(folder, study), study, jobs.measured_with);
  if (!result)
    throw IoError(study.name + ": there is no result; see " + log_of(folder, study).string());
  write_study(folder, *result, jobs.measured_with);
  posix::remove_own_folder(own_folder(folder, study), files_of_a_verification());
  fs::remove(log_of(folder, study));
}

}  // namespace

bool carry_out_side_by_side(const StudyJobs& jobs, const fs::path& folder) {
  if (jobs.studies.empty()) return true;
  posix::catch_stop_signals();
  jobs::PendingJobs work;
  work.count = jobs.studies.size();
  work.at_a_time = jobs.at_a_time;
  work.kind = "studies";
  work.folder = folder;
  work.quiet = jobs.quiet;
  work.run = [&](std::size_t k) {
    const studies::StudyEntry& study = jobs.studies[k];
    std::vector<std::string> arguments{"verify", study.name, "--quiet", "--out",
                                       own_folder(folder, study).string()};
    arguments.insert(arguments.end(), jobs.flags.begin(), jobs.flags.end());
    return jobs::run_program(arguments, log_of(folder, study));
  };
  work.name = [&](std::size_t k) { return jobs.studies[k].name; };
  work.success = [](const jobs::ProcessEnd& end) {
    return end.exit_code == drivers::kSuccess || end.exit_code == drivers::kClaimFailed;
  };
  work.succeeded = [&](std::size_t k) { take_over(jobs, jobs.studies[k], folder); };
  const jobs::JobsEnd end = jobs::run_pending_jobs(work);
  if (!end.failures.empty()) {
    const studies::StudyEntry& study = jobs.studies[end.failures[0].job];
    throw IoError(study.name + ": " + end.failures[0].why + ", see " +
                  log_of(folder, study).string());
  }
  return !end.stopped;
}

}  // namespace traceraft::verify
